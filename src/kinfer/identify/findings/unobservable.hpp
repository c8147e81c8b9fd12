// SPDX-License-Identifier: Apache-2.0
// Sentences on the unobservable parameters of a joint, each with the additional measurement that would determine it.
#pragma once

#include "kinfer/evidence/identification.hpp"

namespace kinfer::identify {

/// Fills `unobservable` of every joint from its unobservable directions, its type and `azimuth_unobservable`.
void list_unobservable(std::vector<JointEstimate>& joints);

}  // namespace kinfer::identify
