// SPDX-License-Identifier: Apache-2.0
// Whether the parameters of two chains correspond.
#pragma once

#include "kinfer/kinematics/chain.hpp"

namespace kinfer {

/// True when both chains have the same number of joints, of the same types and conventions.
bool have_same_joints(const Chain& a, const Chain& b);

}  // namespace kinfer
