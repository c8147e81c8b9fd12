// SPDX-License-Identifier: Apache-2.0
// Pose accuracy and repeatability as defined by ISO 9283, from the rows of a pose set.
#pragma once

#include <vector>

#include "kinfer/evidence/calibration/calibration.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer::calibrate {

/// In the order of each pose's first row; rows without a measured tool point are left out. With another mounting,
/// payload or temperature [K] a pose is another one.
std::vector<PoseAccuracy> evaluate_pose_accuracy(const Chain& before, const Chain& after, const PoseSet& data);

}  // namespace kinfer::calibrate
