// SPDX-License-Identifier: Apache-2.0
// Distances between the axes of consecutive joints.
#pragma once

#include <vector>

#include "kinfer/evidence/identification/identification.hpp"

namespace kinfer::identify {

/// One for each pair of consecutive joints that rotate about an axis or a centre of their own, in the frame of the
/// sensor between them.
std::vector<LinkEstimate> link_estimates(const std::vector<JointEstimate>& joints);

}  // namespace kinfer::identify
