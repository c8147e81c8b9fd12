// Masses for a robot whose file names none: enough to give gravity a direction and a share at each joint.
#pragma once

#include "kinfer/kinematics/chain.hpp"

namespace kinfer {

/// One point mass half way along each link, as heavy as the link is long (15 kg a metre, at least 1 kg a link) and 2 kg
/// at the tool. Only the ratios matter, since each joint's compliance is estimated.
Chain with_guessed_masses(Chain chain);

}  // namespace kinfer
