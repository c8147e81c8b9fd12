// SPDX-License-Identifier: Apache-2.0
// Axes whose standard deviations are no straight lines. A log often tells the angle between a joint's axis and a
// direction w of its parent (gravity on a base at rest, or the only axis that the parent rotates about) far better than
// where the axis lies about w: then it is somewhere on a cone, whose tangents in two logs differ.
#pragma once

#include <vector>

#include "kinfer/evidence/tracking/tracking_model.hpp"

namespace kinfer::identify {

/// By how much each body's axis in its parent leaves its tangent within one standard deviation, in standard deviations
/// across it; 0 where it is straight.
std::vector<double> axis_bends(const TrackingModel& model);

}  // namespace kinfer::identify
