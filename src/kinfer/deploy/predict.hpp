// SPDX-License-Identifier: Apache-2.0
// Prediction: the tool poses of a chain for a list of joint positions.
#pragma once

#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/geometry/pose.hpp"
#include "kinfer/kinematics/chain.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer::deploy {

/// The tool pose of each row in the world, in its named set-up and with its named arm, approached from the previous
/// row. An error where the rows name an arm that the chain lacks.
Result<std::vector<Pose>> predict_poses(const Chain& chain, const PoseSet& rows);

}  // namespace kinfer::deploy
