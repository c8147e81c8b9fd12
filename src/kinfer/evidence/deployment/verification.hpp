// SPDX-License-Identifier: Apache-2.0
// Whether an earlier calibration is still valid on new measurements.
#pragma once

#include <string_view>

#include "kinfer/evidence/calibration/fit_errors.hpp"

namespace kinfer {

enum class VerificationResult {
  valid,
  frames_moved,      ///< with base and tool refitted the errors are small: the instrument or the tool was moved
  robot_changed,     ///< refitting base and tool does not remove the errors
  moved_or_changed,  ///< base, tool or robot: the points are too few to tell which
};
std::string_view name(VerificationResult result);  ///< "valid", "frames_moved", "robot_changed", "moved_or_changed"

struct Verification {
  ErrorStatistics unmodified;       ///< [m] errors of the measured points
  ErrorStatistics frames_refitted;  ///< [m] with base and tool refitted: separates a moved tracker from a changed robot
  int redundancy = 1;  ///< measured numbers beyond the unknowns of base and tool; few: the refit tells little
  VerificationResult result = VerificationResult::valid;
  bool noise_is_known = true;  ///< else only moved frames can be noticed
};

}  // namespace kinfer
