// SPDX-License-Identifier: Apache-2.0
// Chains as MJCF, MuJoCo's model format.
#pragma once

#include <string>

#include "kinfer/kinematics/chain.hpp"

namespace kinfer {

/// MJCF text: one body per joint, whose site has the joint's frame; sites for the tool and the targets. Joint gains and
/// couplings become further joints on the same axis, constrained by <equality>, and so are the joints that close loops
/// (connect: by their points). Kinematics only: bodies without a known
/// mass get a small one (boundmass).
std::string format_mjcf(const Chain& chain);

}  // namespace kinfer
