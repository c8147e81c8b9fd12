// SPDX-License-Identifier: Apache-2.0
#include "kinfer/evidence/identification/joint_estimate.hpp"

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

std::string joint_name(const JointEstimate& joint) {
  return joint.parent + "-" + joint.child;
}

bool all_sufficient(const std::vector<JointForecast>& joints) {
  return std::ranges::all_of(joints, &JointForecast::is_sufficient);
}

}  // namespace kinfer
