// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/faults/fit_monitor.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/track/faults/thresholds.hpp"

namespace kinfer::track {
namespace {

/// Exponential mean that forgets over `time`; `x` limited so that one shock is no fault.
void forget(double& mean, double x, double length, double time) {
  mean += (std::min(x, max_single) - mean) * (1.0 - std::exp(-length / time));
}

}  // namespace

void FitMonitor::reset() {
  std::ranges::fill(fits_, SensorFit{});
}

void FitMonitor::add(const ChainFilter& filter, double time, double length) {
  const Innovations& innovations = filter.innovations();
  for (std::size_t s = 0; s < fits_.size(); ++s) {
    if (innovations.rows[s] == 0) continue;
    SensorFit& fit = fits_[s];
    const double x = innovations.leave_out[s] / innovations.rows[s];
    fit.observed += length;
    forget(fit.quick, x, length, short_mean);
    forget(fit.slow, x, length, long_mean);
  }
  for (std::size_t s = 0; s < fits_.size(); ++s) {
    if (innovations.rows[s] == 0) continue;
    SensorFit& fit = fits_[s];
    // Where all are trusted less already, the tails of the innovations are heavier than those of the hand-over.
    const double tails = std::sqrt(filter.common_inflation());
    fit.strength = std::max(fit.quick / (quick_limit * tails * median_of_others(filter, s, &SensorFit::quick)),
                            fit.slow / (slow_limit * tails * median_of_others(filter, s, &SensorFit::slow)));
    const bool was = fit.is_suspect;
    fit.is_suspect = fit.observed > settling && (was ? fit.quick > recovered_limit : fit.strength > 1.0);
    if (fit.is_suspect && !was) fit.since = time;
  }
}

/// Where most sensors disagree it is the motion that the chain does not explain, and no sensor is at fault.
double FitMonitor::median_of_others(const ChainFilter& filter, std::size_t sensor, double SensorFit::*mean) const {
  std::size_t count = 0;
  for (std::size_t s = 0; s < fits_.size(); ++s)
    if (s != sensor && filter.uses_sensor(s)) ordered_[count++] = fits_[s].*mean;
  if (count == 0) return 1.0;
  const auto middle = ordered_.begin() + static_cast<std::ptrdiff_t>((count - 1) / 2);
  std::nth_element(ordered_.begin(), middle, ordered_.begin() + static_cast<std::ptrdiff_t>(count));
  return std::max(1.0, *middle);
}

int FitMonitor::worst(const ChainFilter& filter) const {
  int worst = -1;
  for (std::size_t s = 0; s < fits_.size(); ++s)
    if (filter.uses_sensor(s) && fits_[s].is_suspect &&
        (worst < 0 || fits_[s].strength > fits_[static_cast<std::size_t>(worst)].strength))
      worst = static_cast<int>(s);
  return worst;
}

int FitMonitor::recovered(const ChainFilter& filter) const {
  for (std::size_t s = 0; s < fits_.size(); ++s)
    if (!filter.uses_sensor(s) && fits_[s].slow < recovered_limit && fits_[s].quick < recovered_limit)
      return static_cast<int>(s);
  return -1;
}

}  // namespace kinfer::track
