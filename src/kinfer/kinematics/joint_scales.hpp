// SPDX-License-Identifier: Apache-2.0
// The units in which differences of joint positions are compared over a set of postures.
#pragma once

#include "kinfer/kinematics/chain.hpp"

namespace kinfer {

/// One per row of `joints` (dof x n), [rad] or [m]: the largest range of the joints of its kind. All angles have one
/// unit, so that a joint that is locked, and whose readings scatter, does not count as one that moves. Angles have at
/// least a thousandth of a radian, where joints of both kinds move a tenth, and lengths a tenth of the tool's range.
VectorXd joint_scales(const Chain& chain, ConstMatrixRef joints);

}  // namespace kinfer
