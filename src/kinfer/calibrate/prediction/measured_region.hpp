// SPDX-License-Identifier: Apache-2.0
// The measured region of a prediction: joint positions that stand for the fitted rows, and how far each reaches.
#pragma once

#include "kinfer/evidence/calibration/prediction_model.hpp"

namespace kinfer::calibrate {

/// At most region_rows of the columns, evenly spread.
MatrixXd representatives(const MatrixXd& joints);

/// The region of these joint positions (dof x n): representatives, spread, reach and edge.
void describe_region(PredictionModel& model, const MatrixXd& joints);

}  // namespace kinfer::calibrate
