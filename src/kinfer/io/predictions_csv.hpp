// Predicted tool poses as CSV (docs/formats.md, `predict`).
#pragma once

#include <span>
#include <string>

#include "kinfer/base/result.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer {

/// x,y,z,qw,qx,qy,qz [m], one row a pose; plus `distance` where the set names anchors (in the base frame). An error
/// where an anchor is named that the robot does not have.
Result<std::string> predictions_csv(std::span<const Pose> poses, const PoseSet& set, const Pose& world_T_base,
                                    std::span<const Vec3> anchors);

}  // namespace kinfer
