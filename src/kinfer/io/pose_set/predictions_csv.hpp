// SPDX-License-Identifier: Apache-2.0
// Predicted tool poses as CSV (docs/formats.md, `predict`).
#pragma once

#include <span>
#include <string>

#include "kinfer/base/result.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer {

/// x,y,z,qw,qx,qy,qz [m], one row per pose; plus `distance` where the set names anchors (in the base frame). An anchor
/// that the robot does not have is an error.
Result<std::string> format_predictions_csv(std::span<const Pose> poses, const PoseSet& set, const Pose& world_T_base,
                                           std::span<const Vec3> anchors);

}  // namespace kinfer
