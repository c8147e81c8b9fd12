// SPDX-License-Identifier: Apache-2.0
#include "kinfer/evidence/deployment/verification.hpp"

namespace kinfer {

std::string_view name(VerificationResult result) {
  switch (result) {
    case VerificationResult::valid:
      return "valid";
    case VerificationResult::frames_moved:
      return "frames_moved";
    case VerificationResult::robot_changed:
      return "robot_changed";
    case VerificationResult::moved_or_changed:
      return "moved_or_changed";
  }
  return "";
}

}  // namespace kinfer
