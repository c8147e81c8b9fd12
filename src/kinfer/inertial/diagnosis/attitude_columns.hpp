// SPDX-License-Identifier: Apache-2.0
// Euler angles where angular rates should be: roll and pitch then tell where the accelerometer sees the vertical, of
// sensors that are tilted or tilt by more than the accelerometer's errors.
#pragma once

#include <optional>

#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer {

struct AttitudeFit {
  double error = 0.0;  ///< [rad] median angle between the vertical by the accelerometer and by the gyroscope's columns
  /// Of the angle that a level sensor would leave, since rates are small angles; each with the accelerometer's errors
  double share_of_level = 1.0;
  double share_of_constant = 1.0;  ///< of the smaller one of that and of what a constant vertical would leave
};

/// The columns taken as roll, pitch, yaw or yaw, pitch, roll in degrees or radians, the best of these; empty where the
/// recording is too short.
std::optional<AttitudeFit> attitude_fit(const InsSensor& sensor);

}  // namespace kinfer
