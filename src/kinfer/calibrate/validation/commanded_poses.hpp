// SPDX-License-Identifier: Apache-2.0
// Which rows of a pose set repeat a commanded pose.
#pragma once

#include <vector>

#include "kinfer/linalg/types.hpp"

namespace kinfer::calibrate {

/// The commanded pose of each row, numbered in the order of their first rows. `joints`: one column a row [rad], [m]. A
/// row repeats the first pose from whose first row every joint differs by no more than its `tolerance`. A million rows
/// take seconds.
std::vector<int> commanded_poses(const MatrixXd& joints, const VectorXd& tolerance);

/// The same to thresholds::same_pose_angle, [rad] or [m] as the joints are.
std::vector<int> commanded_poses(const MatrixXd& joints);

}  // namespace kinfer::calibrate
