// SPDX-License-Identifier: Apache-2.0
// A posture on the command line.
#pragma once

#include <string>

#include "kinfer/base/result.hpp"
#include "kinfer/kinematics/chain.hpp"
#include "kinfer/linalg/types.hpp"

namespace kinfer::cli {

/// Whether "nan" may stand for a position that is not known.
enum class UnknownPosition { refused, allowed };

/// "0,-90,90,0,45,0": one number per joint that has a position, in degrees, and in millimetres of prismatic joints.
/// Errors name the option.
Result<VectorXd> parse_posture(const std::string& option, const std::string& text, const Chain& chain,
                               UnknownPosition unknown = UnknownPosition::refused);

/// Likewise a limit of velocity, acceleration or jerk for each joint, in deg and mm.
Result<VectorXd> parse_motion_limits(const std::string& option, const std::string& text, const Chain& chain);

}  // namespace kinfer::cli
