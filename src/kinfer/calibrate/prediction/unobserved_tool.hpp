// SPDX-License-Identifier: Apache-2.0
// The tool's rotation on the flange where no measurement depends on it: points of one tool point tell nothing of it.
#pragma once

#include "kinfer/evidence/calibration/prediction_model.hpp"
#include "kinfer/kinematics/parameters.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer::calibrate {

/// The model with the rotations of tools that no measurement in `data` depends on, each with its tolerance as standard
/// deviation, independent of the other parameters: predicted orientations are no better known than these. Tools of
/// which no number is among the model's parameters are fixed by the user, and stay so.
PredictionModel with_unobserved_tools(PredictionModel model, const Chain& chain, const Tolerances& tolerances,
                                      const PoseSet& data);

}  // namespace kinfer::calibrate
