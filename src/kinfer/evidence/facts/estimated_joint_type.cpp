// SPDX-License-Identifier: Apache-2.0
#include "kinfer/evidence/facts/estimated_joint_type.hpp"

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

}  // namespace kinfer
