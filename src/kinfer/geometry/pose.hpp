// SPDX-License-Identifier: Apache-2.0
// Pose of a frame in another: base_T_tip maps coordinates in the tip frame to coordinates in the base frame.
#pragma once

#include "kinfer/geometry/rotation.hpp"

namespace kinfer {

struct Pose {
  Mat3 rotation = Mat3::Identity();
  Vec3 position = Vec3::Zero();  ///< [m]

  Pose operator*(const Pose& next) const;
  Vec3 operator*(const Vec3& point) const;
  Pose inverse() const;

  static Pose from_xyz_rpy(const Vec3& xyz, const Vec3& rpy) { return {from_rpy(rpy), xyz}; }
};

}  // namespace kinfer
