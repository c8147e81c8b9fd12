// SPDX-License-Identifier: Apache-2.0
// The unobservable parameters of the joints of a chain.
#pragma once

#include <vector>

#include "kinfer/evidence/identification/joint_estimate.hpp"

namespace kinfer::identify {

/// Fills `unobservable` of every joint from its unobservable directions, its type and `azimuth_unobservable`.
void list_unobservable(std::vector<JointEstimate>& joints);

}  // namespace kinfer::identify
