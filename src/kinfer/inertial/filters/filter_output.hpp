// SPDX-License-Identifier: Apache-2.0
// Result of an orientation filter over a recording.
#pragma once

#include <algorithm>
#include <vector>

#include "kinfer/geometry/rotation.hpp"

namespace kinfer {

/// Orientations and gyro errors of a sensor: true rate = (1 + scale) (rate - bias). Filters that do not estimate gyro
/// errors leave the bias empty.
struct FilterOutput {
  std::vector<Quat> world_q_sensor{};  ///< sensor to world, one per row
  std::vector<double> bias_time{};     ///< [s] ascending
  std::vector<Vec3> bias{};            ///< [rad/s] in the sensor, one per bias_time
  Mat3 scale = Mat3::Zero();

  /// The bias must not be empty; it is constant up to each bias_time and after the last.
  Vec3 true_rate(const Vec3& angular_velocity, double time) const {
    const auto after = std::ranges::lower_bound(bias_time, time) - bias_time.begin();
    const Vec3 unbiased = angular_velocity - bias[std::min(static_cast<std::size_t>(after), bias.size() - 1)];
    return unbiased + scale * unbiased;
  }
};

}  // namespace kinfer
