#include "kinfer/evidence/identification.hpp"

namespace kinfer {

std::string_view name(FoundJointType type) {
  switch (type) {
    case FoundJointType::revolute:
      return "revolute";
    case FoundJointType::prismatic:
      return "prismatic";
    case FoundJointType::universal:
      return "universal";
    case FoundJointType::spherical:
      return "spherical";
    case FoundJointType::rigid:
      return "rigid";
  }
  return "rigid";
}

}  // namespace kinfer
