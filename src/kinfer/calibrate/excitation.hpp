// What the joints of a pose set do, and what looks wrong before any fit.
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

/// In words: joints that do not move, readings that look like degrees, repeated rows, readings that differ from what
/// was commanded.
std::vector<std::string> findings(const PoseSet& set, const std::vector<JointExcitation>& joints);

}  // namespace kinfer
