// SPDX-License-Identifier: Apache-2.0
// Rest detection: rate and specific force, averaged over 0.05 s, stay close to their own mean over the last 0.5 s, and
// the rate is small enough to be a bias.
#pragma once

#include <span>
#include <vector>

#include "kinfer/inertial/rest/low_pass.hpp"
#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer {

/// [s] Shortest rest that is listed. Larger: fewer, better biases. Data: not recorded.
inline constexpr double min_rest_duration = 1.0;

struct RestOptions {
  double noise_time = 0.05;             ///< [s] averaging of noise; longer detects smaller motions, later
  double mean_time = 0.5;               ///< [s] averaging time of the reference mean
  double rate_threshold = 8.7e-3;       ///< [rad/s] (0.5 °/s) a larger deviation from the mean is motion
  double acceleration_threshold = 0.2;  ///< [m/s²] likewise
  double max_gyro_bias = 0.052;         ///< [rad/s] (3 °/s) a larger steady rate is a rotation, not a bias ...
  double largest_gyro_bias = 0.175;     ///< [rad/s] (10 °/s) ... unless the sensor is never at rest otherwise
  double shortest = 0.25;               ///< [s] shorter stillness is not rest
  double listed = min_rest_duration;    ///< [s] shorter rests, without their margins, are not listed
};

/// Online: one per sensor, copyable.
struct RestDetector {
  LowPass<Vec3> fast_rate{Vec3::Zero()}, slow_rate{Vec3::Zero()};
  LowPass<Vec3> fast_acceleration{Vec3::Zero()}, slow_acceleration{Vec3::Zero()};
  double still = 0.0;  ///< [s] duration of the current stillness

  void add(const InsSample& sample, double dt, const RestOptions& options);
  bool at_rest(const RestOptions& options) const { return still >= options.shortest; }
};

/// A time segment (rows first to last) in which a sensor was stationary, and its measurements there.
struct RestPeriod {
  std::size_t first_row = 0, last_row = 0;
  double begin = 0.0, end = 0.0;         ///< [s]
  Vec3 angular_velocity = Vec3::Zero();  ///< [rad/s] mean: the gyro bias if the base is stationary
  Vec3 rate_sd = Vec3::Zero();           ///< [rad/s] of a single row
  Vec3 acceleration = Vec3::Zero();      ///< [m/s²] mean
  Vec3 acceleration_sd = Vec3::Zero();
  Vec3 rotation = Vec3::Zero();  ///< [rad/s] steady rate that was taken out of the mean (steady_rotation.hpp)
  double seconds() const { return end - begin; }
};

/// [s] Excluded at both ends of a rest, where the detector lags. Larger: cleaner and shorter rests. Data: not recorded.
inline constexpr double rest_margin = 0.1;

/// All rests of a sensor that last for `listed`, without the margins.
std::vector<RestPeriod> rest_periods(const InsSensor& sensor, std::span<const double> time,
                                     const RestOptions& options = {});

/// A rest in parts of equal length, each of `seconds` or up to twice as long.
std::vector<RestPeriod> in_parts(const RestPeriod& rest, double seconds, const InsSensor& sensor,
                                 std::span<const double> time);

/// Gyro bias from the rests: mean weighted by duration, and scatter between the rests.
struct RestBias {
  Vec3 mean = Vec3::Zero();    ///< [rad/s]
  Vec3 spread = Vec3::Zero();  ///< [rad/s] weighted standard deviation over the rests; 0 for a single one
  double seconds = 0.0;        ///< [s] total duration of rest; 0: bias unknown
};
RestBias bias_at_rest(std::span<const RestPeriod> rest_periods);

}  // namespace kinfer
