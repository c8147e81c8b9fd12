// SPDX-License-Identifier: Apache-2.0
// Predicted tool poses as CSV (docs/formats.md, `predict`).
#pragma once

#include <span>
#include <string>

#include "kinfer/base/result.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer {

/// Standard deviations of a predicted pose about the axes of the world.
struct PoseDeviations {
  Vec3 position = Vec3::Zero();  ///< [m]
  Vec3 rotation = Vec3::Zero();  ///< [rad]
};

/// x,y,z,qw,qx,qy,qz [m], one row per pose; plus sd_x,sd_y,sd_z [m] and sd_rx,sd_ry,sd_rz [rad] where `deviations` are
/// given, and `distance` where the set names anchors (in the base frame). An anchor that the robot does not have is an
/// error.
Result<std::string> format_predictions_csv(std::span<const Pose> poses, const PoseSet& set, const Pose& world_T_base,
                                           std::span<const Vec3> anchors,
                                           std::span<const PoseDeviations> deviations = {});

}  // namespace kinfer
