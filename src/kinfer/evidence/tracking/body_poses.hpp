// SPDX-License-Identifier: Apache-2.0
// Where the bodies of a tracked machine are at given joint positions.
#pragma once

#include <vector>

#include "kinfer/evidence/tracking/tracking_model.hpp"

namespace kinfer {

/// parent_T_child of a body at its joint positions, degrees_of_freedom() of them [rad] or [m].
Pose body_pose(const TrackingBody& body, ConstVectorRef positions);

/// base_T_body of every body, in order; `q`: as TrackingModel::positions() many.
std::vector<Pose> body_poses(const TrackingModel& model, ConstVectorRef q);

/// base_T_tool.
Pose tool_pose(const TrackingModel& model, const std::vector<Pose>& bodies);

}  // namespace kinfer
