// SPDX-License-Identifier: Apache-2.0
// Merges two pose sets of the same robot.
#pragma once

#include "kinfer/measurement/pose_set.hpp"

namespace kinfer {

/// The rows of `fitted`, labelled train, then those of `held_out`, labelled holdout. Line numbers refer to each file.
PoseSet merge_pose_sets(const PoseSet& fitted, const PoseSet& held_out);

}  // namespace kinfer
