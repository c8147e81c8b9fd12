// SPDX-License-Identifier: Apache-2.0
// Approximate masses for a robot whose file has none: they set the relative gravity torques of the joints.
#pragma once

#include "kinfer/kinematics/chain.hpp"

namespace kinfer::calibrate {

/// One point mass at the middle of each link, proportional to its length (15 kg/m, at least 1 kg per link), and 2 kg at
/// the tool. Only the ratios matter, since each joint's compliance is estimated.
Chain with_approximate_masses(Chain chain);

}  // namespace kinfer::calibrate
