// SPDX-License-Identifier: Apache-2.0
#include "kinfer/evidence/facts/estimated_joint_type.hpp"

#include <algorithm>

namespace kinfer {

std::string_view name(EstimatedJointType type) {
  switch (type) {
    case EstimatedJointType::revolute:
      return "revolute";
    case EstimatedJointType::prismatic:
      return "prismatic";
    case EstimatedJointType::universal:
      return "universal";
    case EstimatedJointType::spherical:
      return "spherical";
    case EstimatedJointType::rigid:
      break;
  }
  return "rigid";
}

EstimatedJointType most_probable(const JointTypeProbabilities& probabilities) {
  const auto& p = probabilities.of_type;
  return static_cast<EstimatedJointType>(std::ranges::max_element(p) - p.begin());
}

}  // namespace kinfer
