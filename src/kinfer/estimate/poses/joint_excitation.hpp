// SPDX-License-Identifier: Apache-2.0
// Joint ranges covered by a pose set.
#pragma once

#include <string>
#include <vector>

#include "kinfer/kinematics/chain.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer {

struct JointExcitation {
  std::string name;
  bool is_revolute = true;  ///< revolute: [rad]; else [m]
  double lower = 0.0, upper = 0.0, sd = 0.0;
};
std::vector<JointExcitation> measure_joint_excitation(const Chain& chain, const PoseSet& set);

}  // namespace kinfer
