// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/solver/noise_update.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/geometry/statistics.hpp"

namespace kinfer {
namespace {

/// Autocovariance of the offsets at `lag` intervals.
double covariance(const std::vector<std::array<float, 3>>& offset, std::size_t axis, std::size_t lag) {
  double sum = 0.0, n = 0.0;
  for (std::size_t i = lag; i < offset.size(); ++i) {
    const double product = double{offset[i][axis]} * double{offset[i - lag][axis]};
    if (!std::isfinite(product)) continue;
    sum += product;
    n += 1.0;
  }
  return n > 0.0 ? sum / n : 0.0;
}

/// Integrated autocorrelation time [intervals] of an axis: variance of a mean over a long time relative to white noise,
/// 1 + 2 Σ ρ over the lags of the offsets' autocorrelation up to the first that is not positive, at most a tenth of the
/// recording; at least 1.
double autocorrelation_time(const std::vector<std::array<float, 3>>& offset, std::size_t axis) {
  const double variance = covariance(offset, axis, 0);
  double memory = 1.0;
  for (std::size_t lag = 1; variance > 0.0 && lag < offset.size() / 10; ++lag) {
    const double rho = covariance(offset, axis, lag) / variance;
    if (rho <= 0.0) break;
    memory += 2.0 * rho;
  }
  return memory;
}

/// Mean of the blocks' mean squares without the largest twentieth, which are spikes and collisions.
double trimmed_mean(std::vector<float> values) {
  std::erase_if(values, [](float value) { return !std::isfinite(value); });
  if (values.empty()) return 0.0;
  const auto kept = values.begin() + static_cast<std::ptrdiff_t>(values.size() - values.size() / 20);
  std::nth_element(values.begin(), kept - 1, values.end());
  double sum = 0.0;
  for (auto value = values.begin(); value != kept; ++value) sum += *value;
  return sum / static_cast<double>(kept - values.begin());
}

bool has_residuals(const InstrumentFit& fit) {
  return std::ranges::any_of(fit.block, [](float value) { return std::isfinite(value); });
}

/// Ratio of residual noise to the instrument's own noise of each sensor, clamped near the median of the sensors:
/// otherwise a fit may follow one sensor exactly and ignore another.
std::vector<double> regularised(std::vector<double> estimated) {
  constexpr double near = 1.5;
  const double usual = estimated.empty() ? 1.0 : median(estimated);
  for (double& factor : estimated) factor = std::max(1.0, std::clamp(factor, usual / near, usual * near));
  return estimated;
}

/// Of one instrument type of all sensors that have residuals; those outside of the chain have none. `noise` and `fit`
/// select it in InsNoise and SensorFit.
void estimate_instrument_noise(std::vector<InsNoise>& all, const InsProblem& problem, const InsCost& cost,
                               double InsNoise::*noise, InstrumentFit SensorFit::*fit) {
  std::vector<std::size_t> fitted;
  std::vector<double> estimated;
  for (std::size_t s = 0; s < problem.sensors.size(); ++s) {
    if (!has_residuals(cost.sensors[s].*fit)) continue;
    fitted.push_back(s);
    estimated.push_back(problem.sensors[s].noise.*noise / problem.sensors[s].noise_floor.*noise *
                        std::sqrt(trimmed_mean((cost.sensors[s].*fit).block)));
  }
  const std::vector<double> factors = regularised(estimated);
  for (std::size_t i = 0; i < fitted.size(); ++i)
    all[fitted[i]].*noise = factors[i] * problem.sensors[fitted[i]].noise_floor.*noise;
}

std::vector<InsNoise> estimated_noise(const InsProblem& problem, const InsCost& cost) {
  std::vector<InsNoise> estimated;
  for (const InsMeasurements& sensor : problem.sensors) estimated.push_back(sensor.noise);
  estimate_instrument_noise(estimated, problem, cost, &InsNoise::angular_velocity, &SensorFit::angular_velocity);
  estimate_instrument_noise(estimated, problem, cost, &InsNoise::force, &SensorFit::force);
  return estimated;
}

bool differ(const InsProblem& problem, const std::vector<InsNoise>& estimated) {
  constexpr double notable = 0.05;
  const auto differs = [](double a, double b) { return std::abs(b - a) > notable * a; };
  for (std::size_t s = 0; s < estimated.size(); ++s) {
    const InsNoise& noise = problem.sensors[s].noise;
    if (differs(noise.angular_velocity, estimated[s].angular_velocity) || differs(noise.force, estimated[s].force))
      return true;
  }
  return false;
}

/// The offsets as far as the robust loss lets them act on the fit: intervals with shocks hardly do.
InstrumentFit limited(const InstrumentFit& fit) {
  constexpr float most = 5.6f;  // [sigma] root of the limit of robust() for a block of four rows
  InstrumentFit result{.squares = fit.squares, .terms = fit.terms, .block = {}, .offset = fit.offset};
  for (auto& offset : result.offset)
    for (float& value : offset)
      if (std::isfinite(value)) value = std::clamp(value, -most, most);
  return result;
}

/// Autocovariance of an axis' offsets at one interval, where it is certainly positive; else 0.
double persistent_variance_of_axis(const InstrumentFit& fit, std::size_t axis) {
  constexpr double certainty = 4.0;  // standard deviations of the estimate for white noise, 1 / √n of the variance
  const double next = covariance(fit.offset, axis, 1),
               sd = covariance(fit.offset, axis, 0) /
                    std::sqrt(std::max<double>(1.0, static_cast<double>(fit.offset.size())));
  return next > certainty * sd ? next : 0.0;
}

/// Variance of the offsets' mean over a long time, relative to that of white noise with the instrument's sd; mean over
/// the axes. Of a revolute joint's two sensors one axis always fits: the joint position follows it.
double long_run_variance(const InstrumentFit& fit) {
  double sum = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double memory = persistent_variance_of_axis(fit, axis) > 0.0 ? autocorrelation_time(fit.offset, axis) : 1.0;
    sum += covariance(fit.offset, axis, 0) * memory / 3.0;
  }
  return sum;
}

}  // namespace

std::vector<InsNoise> long_run_noise(const InsProblem& problem, const InsCost& cost) {
  std::vector<InsNoise> noise;
  for (std::size_t s = 0; s < problem.sensors.size(); ++s) {
    InsNoise& own = noise.emplace_back(problem.sensors[s].noise);
    own.angular_velocity *= std::sqrt(std::max(1.0, long_run_variance(limited(cost.sensors[s].angular_velocity))));
    own.force *= std::sqrt(std::max(1.0, long_run_variance(limited(cost.sensors[s].force))));
  }
  return noise;
}

std::vector<InsNoise> recorded_noise(const InsProblem& problem, const InsCost& cost) {
  const auto recorded = [](double noise, const std::vector<float>& mean_squares, const std::vector<InsBlock>& blocks) {
    std::vector<float> with_excess = mean_squares;
    for (std::size_t k = 0; k < with_excess.size(); ++k) with_excess[k] *= blocks[k].excess;
    const double usual = trimmed_mean(mean_squares);
    return usual > 0.0 ? noise * std::sqrt(trimmed_mean(with_excess) / usual) : noise;
  };
  std::vector<InsNoise> all;
  for (std::size_t s = 0; s < problem.sensors.size(); ++s) {
    const InsMeasurements& r = problem.sensors[s];
    const SensorFit& fit = cost.sensors[s];
    all.push_back({recorded(r.noise.angular_velocity, fit.angular_velocity.block, r.angular_velocity),
                   recorded(r.noise.force, fit.force.block, r.force)});
  }
  return all;
}

double persistent_variance(const InstrumentFit& fit) {
  double sum = 0.0;
  const InstrumentFit acting = limited(fit);
  for (std::size_t axis = 0; axis < 3; ++axis) sum += persistent_variance_of_axis(acting, axis);
  return sum;
}

bool needs_reweighting(const InsProblem& problem, const InsCost& cost) {
  return differ(problem, estimated_noise(problem, cost));
}

bool update_noise(InsProblem& problem, const InsCost& cost) {
  const std::vector<InsNoise> estimated = estimated_noise(problem, cost);
  const bool changed = differ(problem, estimated);
  for (std::size_t s = 0; s < estimated.size(); ++s) problem.sensors[s].noise = estimated[s];
  return changed;
}

}  // namespace kinfer
