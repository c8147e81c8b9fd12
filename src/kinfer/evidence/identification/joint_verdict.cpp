// SPDX-License-Identifier: Apache-2.0
#include "kinfer/evidence/identification/joint_verdict.hpp"

namespace kinfer {

std::string_view name(JointUsability usability) {
  switch (usability) {
    case JointUsability::use:
      return "use";
    case JointUsability::use_with_care:
      return "use_with_care";
    case JointUsability::do_not_use:
      return "do_not_use";
    case JointUsability::unknown:
      break;
  }
  return "unknown";
}

std::string_view name(JointDoubtKind kind) {
  switch (kind) {
    case JointDoubtKind::not_connected:
      return "not_connected";
    case JointDoubtKind::weakly_connected:
      return "weakly_connected";
    case JointDoubtKind::partly_connected:
      return "partly_connected";
    case JointDoubtKind::changed:
      return "changed";
    case JointDoubtKind::beyond_reach:
      return "beyond_reach";
    case JointDoubtKind::not_moved:
      return "not_moved";
    case JointDoubtKind::undetermined:
      return "undetermined";
    case JointDoubtKind::unsafe_order:
      return "unsafe_order";
    case JointDoubtKind::not_fitted:
      return "not_fitted";
    case JointDoubtKind::unexplained_motion:
      return "unexplained_motion";
    case JointDoubtKind::uncertain_type:
      return "uncertain_type";
    case JointDoubtKind::inaccurate:
      break;
  }
  return "inaccurate";
}

}  // namespace kinfer
