// What the joints of a pose set do.
#pragma once

#include <string>
#include <vector>

#include "kinfer/kinematics/chain.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer {

struct JointExcitation {
  std::string name;
  bool turns = true;  ///< revolute: [rad]; else [m]
  double lowest = 0.0, highest = 0.0, sd = 0.0;
};
std::vector<JointExcitation> joint_excitation(const Chain& chain, const PoseSet& set);

}  // namespace kinfer
