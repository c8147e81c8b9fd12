// SPDX-License-Identifier: Apache-2.0
// A frame whose rotation an estimate changes by small angles.
#pragma once

#include "kinfer/geometry/pose.hpp"

namespace kinfer {

/// A frame with a small rotation (rx, ry, rz) that an estimate may change: full rotation = rotation · Rx(rx) Ry(ry)
/// Rz(rz). Estimating the small rotation instead of roll, pitch, yaw avoids their singularity at pitch = ±90°.
struct Frame {
  Vec3 xyz = Vec3::Zero();  ///< [m]
  Mat3 rotation = Mat3::Identity();
  Vec3 small_rotation = Vec3::Zero();  ///< [rad]

  Pose pose() const;
  static Frame from_pose(const Pose& pose) { return {pose.position, pose.rotation, Vec3::Zero()}; }
};

/// Multiplies the small rotation into the rotation matrix: the same pose.
void fold(Frame& frame);

}  // namespace kinfer
