// SPDX-License-Identifier: Apache-2.0
// What the table of terms says of each candidate: whether it is in the model, what it contributes, and why not.
#pragma once

#include <vector>

#include "kinfer/calibrate/terms/selection/weighed_geometry.hpp"
#include "kinfer/calibrate/terms/selection/weighed_terms.hpp"

namespace kinfer::calibrate {

/// One step per candidate, with the held-out errors of the model that has the terms up to it.
std::vector<WeighedStep> term_steps(const WeighedTerms& terms, const SelectionData& data);

}  // namespace kinfer::calibrate
