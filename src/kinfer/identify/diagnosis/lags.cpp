// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/diagnosis/lags.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinfer/base/parallel.hpp"
#include "kinfer/identify/diagnosis/thresholds.hpp"
#include "kinfer/inertial/diagnosis/section_fit.hpp"
#include "kinfer/measurement/ins/ins_screening.hpp"

namespace kinfer::identify {
namespace {

/// The samples that were logged `lag` later, by linear interpolation.
TriadColumns shifted(const TriadColumns& triad, std::span<const double> time, double lag) {
  TriadColumns result = triad;
  std::size_t after = 0;
  for (std::size_t row = 0; row < time.size(); ++row) {
    const double t = time[row] + lag;
    while (after < time.size() && time[after] < t) ++after;
    const bool inside = after > 0 && after < time.size();
    const double share = inside ? (t - time[after - 1]) / (time[after] - time[after - 1]) : 0.0;
    for (std::size_t k = 0; k < 3; ++k)
      result.axis[k][row] = inside ? static_cast<float>((1.0 - share) * static_cast<double>(triad.axis[k][after - 1]) +
                                                        share * static_cast<double>(triad.axis[k][after]))
                                   : std::numeric_limits<float>::quiet_NaN();
  }
  return result;
}

}  // namespace

void mend_lags(MendedLog& log, int threads) {
  const std::size_t sensors = log.log().sensors.size();
  std::vector<InstrumentLag> lags(sensors);
  parallel_for(sensors, threads, [&](std::size_t s) {
    const InsSensor& sensor = log.log().sensors[s];
    const auto signals =
        section_signals(sensor.acceleration, sensor.angular_velocity, log.log().time(sensor), max_quiet_rate);
    if (signals) lags[s] = instrument_lag(*signals, Mat3::Identity());
  });
  for (std::size_t s = 0; s < sensors; ++s) {
    const InstrumentLag& lag = lags[s];
    const bool is_certain =
        lag.gain > min_lag_gain && lag.half_gain > -max_half_lag_loss * lag.gain && lag.sd > 0.0 && lag.sd < max_lag_sd;
    const bool is_one_of_several = lag.rival_gain > max_rival_lag_gain * lag.gain;
    if (std::abs(lag.lag) < min_reported_lag || !is_certain || is_one_of_several) continue;
    InsSensor& sensor = log.edit().sensors[s];
    sensor.acceleration = shifted(sensor.acceleration, log.log().time(sensor), lag.lag);
    flag_faults(sensor);
    log.findings.push_back(
        {.kind = FindingKind::instruments_out_of_step,
         .severity = Severity::warning,
         .values = {{"sensor", sensor.name}, {"lag", lag.lag}, {"sd", lag.sd}, {"log_likelihood_gain", lag.gain}},
         .applied = true});
  }
}

}  // namespace kinfer::identify
