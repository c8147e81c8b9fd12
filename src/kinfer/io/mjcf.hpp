// Chains as MJCF, MuJoCo's model format.
#pragma once

#include <string>

#include "kinfer/kinematics/chain.hpp"

namespace kinfer {

/// MJCF text: one body a joint, its frame that of the joint; sites for the tool and the targets. Joint gains and
/// couplings are further joints on the same axis, tied by <equality>. Kinematics only: masses that the chain does not
/// carry are what the engine needs at least.
std::string mjcf(const Chain& chain);

}  // namespace kinfer
