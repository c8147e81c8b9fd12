// SPDX-License-Identifier: Apache-2.0
// What the tool is to reach: a point, and as much of the orientation as the task needs.
#pragma once

#include <variant>

#include "kinfer/geometry/pose.hpp"

namespace kinfer {

struct FreeOrientation {};
/// The tool axis points along this unit vector (world); the rotation about it is free.
struct AxisGoal {
  Vec3 direction = Vec3::UnitZ();
};
/// The tool axis rises at this angle above the world's xy plane [rad], −π/2 to π/2.
struct PitchGoal {
  double angle = 0.0;
};
/// world_R_tool
struct FullGoal {
  Mat3 rotation = Mat3::Identity();
};
using OrientationGoal = std::variant<FreeOrientation, AxisGoal, PitchGoal, FullGoal>;

struct ReachTarget {
  Vec3 position = Vec3::Zero();  ///< [m] of the tool point, in the world
  OrientationGoal orientation = FreeOrientation{};
};

}  // namespace kinfer
