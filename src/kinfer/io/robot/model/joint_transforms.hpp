// SPDX-License-Identifier: Apache-2.0
// A joint as URDF and MJCF represent it: a fixed transform, the motion about or along an axis, a fixed transform.
#pragma once

#include <string>
#include <vector>

#include "kinfer/kinematics/chain.hpp"

namespace kinfer {

struct JointTransforms {
  Pose before, after;
  Vec3 axis = Vec3::UnitZ();  ///< unit, in the frame after `before`
};
JointTransforms joint_transforms(const Link& link);

/// A further term of a joint's variable: multiplier · position of `joint` is added.
struct MimicTerm {
  std::string joint;
  double multiplier = 1.0;
};

/// The terms of joint `index` beyond its own position: (gain − 1) times that position, and its couplings.
std::vector<MimicTerm> mimic_terms(const Chain& chain, int index);

}  // namespace kinfer
