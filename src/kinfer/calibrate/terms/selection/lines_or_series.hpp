// SPDX-License-Identifier: Apache-2.0
// Harmonics that were found in the residuals: single lines of the spectrum, or a whole series of a joint.
#pragma once

#include <vector>

#include "kinfer/calibrate/terms/selection/weighed_geometry.hpp"

namespace kinfer::calibrate {

/// Models of terms, the best one first; of few rows also that of lines, where series are better.
std::vector<WeighedModel> weigh_terms(const SelectionData& data, const Estimate& geometry);

}  // namespace kinfer::calibrate
