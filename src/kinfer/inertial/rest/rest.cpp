// SPDX-License-Identifier: Apache-2.0
#include "kinfer/inertial/rest/rest.hpp"

#include <algorithm>
#include <cmath>

namespace kinfer {
namespace {

/// Mean and standard deviation over the usable rows of a rest.
void summarise(const InsSensor& sensor, std::span<const double> time, RestPeriod& rest) {
  Vec3 angular_velocity = Vec3::Zero(), rate2 = Vec3::Zero(), force = Vec3::Zero(), force2 = Vec3::Zero();
  double rates = 0.0, forces = 0.0;
  for (std::size_t row = rest.first_row; row <= rest.last_row; ++row) {
    const InsSample s = sample(sensor, time, row);
    if (s.has_angular_velocity)
      angular_velocity += s.angular_velocity, rate2 += s.angular_velocity.cwiseAbs2(), rates += 1.0;
    if (s.has_acceleration) force += s.acceleration, force2 += s.acceleration.cwiseAbs2(), forces += 1.0;
  }
  if (rates <= 1.0 || forces <= 1.0) return;
  rest.angular_velocity = angular_velocity / rates;
  rest.acceleration = force / forces;
  rest.rate_sd = (rate2 / rates - rest.angular_velocity.cwiseAbs2()).cwiseMax(0.0).cwiseSqrt();
  rest.acceleration_sd = (force2 / forces - rest.acceleration.cwiseAbs2()).cwiseMax(0.0).cwiseSqrt();
}

/// Adds the rest without its margins, if `listed` [s] of it are left.
void add_rest(const InsSensor& sensor, std::span<const double> time, std::size_t first, std::size_t last, double listed,
              std::vector<RestPeriod>& found) {
  while (first < last && time[first] < time[last] && time[last] - time[first] > listed &&
         sensor.faults[first] & (angular_velocity_missing | acceleration_missing))
    ++first;
  RestPeriod rest{.first_row = first, .last_row = last};
  const double begin = time[first] + rest_margin, end = time[last] - rest_margin;
  while (rest.first_row < last && time[rest.first_row] < begin) ++rest.first_row;
  while (rest.last_row > first && time[rest.last_row] > end) --rest.last_row;
  if (rest.first_row >= rest.last_row) return;
  rest.begin = time[rest.first_row];
  rest.end = time[rest.last_row];
  if (rest.seconds() < listed) return;
  summarise(sensor, time, rest);
  found.push_back(rest);
}

}  // namespace

void RestDetector::add(const InsSample& sample, double dt, const RestOptions& options) {
  if (!sample.has_angular_velocity || !sample.has_acceleration || sample.angular_velocity_clipped) {
    still = 0.0;
    return;
  }
  fast_rate.add(sample.angular_velocity, dt, options.noise_time);
  slow_rate.add(sample.angular_velocity, dt, options.mean_time);
  fast_acceleration.add(sample.acceleration, dt, options.noise_time);
  slow_acceleration.add(sample.acceleration, dt, options.mean_time);
  const bool is_near_mean = (fast_rate.value - slow_rate.value).norm() < options.rate_threshold &&
                            (fast_acceleration.value - slow_acceleration.value).norm() < options.acceleration_threshold;
  if (!is_near_mean) {  // restart the mean, so that motion is forgotten at once when it ends
    slow_rate = {fast_rate.value, dt};
    slow_acceleration = {fast_acceleration.value, dt};
  }
  const bool quiet = is_near_mean && slow_rate.value.cwiseAbs().maxCoeff() < options.max_gyro_bias;
  still = quiet ? still + dt : 0.0;
}

namespace {

/// Whether the row may be another sensor's.
bool is_empty(const InsSample& s) {
  return !s.has_angular_velocity && !s.has_acceleration;
}

/// Median time between the sensor's own samples.
double own_period(const InsSensor& sensor, std::span<const double> time) {
  std::vector<double> own;
  for (std::size_t row = 0; row < time.size(); ++row)
    if ((sensor.faults[row] & (acceleration_missing | angular_velocity_missing)) !=
        (acceleration_missing | angular_velocity_missing))
      own.push_back(time[row]);
  return median_period(own);
}

std::vector<RestPeriod> find_rests(const InsSensor& sensor, std::span<const double> time, const RestOptions& options) {
  std::vector<RestPeriod> found;
  RestDetector detector;
  const double usual = own_period(sensor, time);
  std::size_t first = 0;
  bool resting = false;
  double last = time.empty() ? 0.0 : time.front() - usual;
  for (std::size_t row = 0; row < time.size(); ++row) {
    const double dt = time[row] - last;
    const InsSample s = sample(sensor, time, row);
    if (is_empty(s) && dt < options.mean_time) continue;  // row of another sensor
    last = time[row];
    if (dt > gap_factor * usual && dt > options.noise_time) detector = {};
    detector.add(s, std::min(dt, options.mean_time), options);
    const bool still = detector.at_rest(options);
    if (resting && !still) add_rest(sensor, time, first, row - 1, options.listed, found);
    if (!resting && still) {
      first = row;
      while (first > 0 && time[row] - time[first - 1] < detector.still) --first;
    }
    resting = still;
  }
  if (resting) add_rest(sensor, time, first, time.size() - 1, options.listed, found);
  return found;
}

}  // namespace

std::vector<RestPeriod> rest_periods(const InsSensor& sensor, std::span<const double> time,
                                     const RestOptions& options) {
  std::vector<RestPeriod> found = find_rests(sensor, time, options);
  if (!found.empty()) return found;
  RestOptions large_bias = options;
  large_bias.max_gyro_bias = std::max(options.max_gyro_bias, options.largest_gyro_bias);
  return find_rests(sensor, time, large_bias);
}

std::vector<RestPeriod> in_parts(const RestPeriod& rest, double seconds, const InsSensor& sensor,
                                 std::span<const double> time) {
  const auto count = std::max<std::size_t>(1, static_cast<std::size_t>(rest.seconds() / seconds)),
             rows = rest.last_row - rest.first_row + 1;
  std::vector<RestPeriod> parts;
  for (std::size_t i = 0; i < count; ++i) {
    RestPeriod part{.first_row = rest.first_row + i * rows / count,
                    .last_row = rest.first_row + (i + 1) * rows / count - 1};
    part.begin = time[part.first_row];
    part.end = time[part.last_row];
    summarise(sensor, time, part);
    if (part.acceleration.norm() > 0.0) parts.push_back(part);
  }
  return parts;
}

RestBias bias_at_rest(std::span<const RestPeriod> rest_periods) {
  RestBias bias;
  for (const RestPeriod& rest : rest_periods)
    bias.mean += rest.seconds() * rest.angular_velocity, bias.seconds += rest.seconds();
  if (bias.seconds <= 0.0) return bias;
  bias.mean /= bias.seconds;
  for (const RestPeriod& rest : rest_periods)
    bias.spread += rest.seconds() * (rest.angular_velocity - bias.mean).cwiseAbs2();
  bias.spread = (bias.spread / bias.seconds).cwiseSqrt();
  return bias;
}

}  // namespace kinfer
