// SPDX-License-Identifier: Apache-2.0
// Non-geometric terms that weigh themselves: one fit with all that the data could tell, the size of each group of
// parameters by the marginal likelihood, and the proof of the result by held-out errors.
#pragma once

#include "kinfer/calibrate/terms/selection/weighed_geometry.hpp"

namespace kinfer::calibrate {

/// Geometry, and the terms that the marginal likelihood supports and the held-out errors do not speak against.
WeighedModel weigh_model(const SelectionData& data, const Estimate& geometry);

}  // namespace kinfer::calibrate
