// SPDX-License-Identifier: Apache-2.0
// A displacement field beside the terms of a model: whether the marginal likelihood supports it, and its proof by
// held-out errors.
#pragma once

#include <vector>

#include "kinfer/calibrate/terms/selection/weighed_geometry.hpp"

namespace kinfer::calibrate {

/// Adds the step of the field, and the field itself where the data support it and held-out errors do not speak against
/// it. `extrapolation`: splits along the joint positions.
void weigh_field(const SelectionData& data, const std::vector<Split>& extrapolation, WeighedModel& model);

/// The field that the data support best, whatever held-out errors say of it.
void add_field(const SelectionData& data, WeighedModel& model);

}  // namespace kinfer::calibrate
