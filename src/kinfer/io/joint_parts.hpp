// A joint as URDF and MJCF have it: fixed before its motion, the motion about or along an axis, fixed after it.
#pragma once

#include <string>
#include <vector>

#include "kinfer/kinematics/chain.hpp"

namespace kinfer {

struct JointParts {
  Pose before, after;
  Vec3 axis = Vec3::UnitZ();  ///< unit, in the frame behind `before`
};
JointParts parts_of(const Link& link);

/// A reading that moves a joint's variable besides the joint's own: factor · reading of `joint` is added.
struct Follower {
  std::string joint;
  double multiplier = 1.0;
};

/// What moves joint `index` beyond its own reading: its gain beyond 1, and its couplings.
std::vector<Follower> followers(const Chain& chain, int index);

}  // namespace kinfer
