// SPDX-License-Identifier: Apache-2.0
// Prediction: the tool poses of a chain for a list of joint positions.
#pragma once

#include <optional>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/estimate/poses/pose_uncertainty.hpp"
#include "kinfer/evidence/facts/findings.hpp"
#include "kinfer/geometry/pose.hpp"
#include "kinfer/kinematics/chain.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer::deploy {

/// The tool pose of each row in the world, in its named set-up and with its named arm, approached from the previous
/// row. Outside the measured region the corrections of gears fade, where a prediction model is given. An
/// error where the rows name an arm that the chain lacks.
Result<std::vector<Pose>> predict_poses(const Chain& chain, const PoseSet& rows,
                                        const std::optional<PredictionModel>& model = std::nullopt);

/// The uncertainty of these poses by the calibration's own figures.
Result<std::vector<PoseUncertainty>> predict_uncertainties(const Chain& chain, const PredictionModel& model,
                                                           const PoseSet& rows);

/// The rows whose joint positions lie outside the region that the calibration measured; nothing where there are none.
std::optional<Finding> find_rows_outside(const PredictionModel& model, const PoseSet& rows);

}  // namespace kinfer::deploy
