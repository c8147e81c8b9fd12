// SPDX-License-Identifier: Apache-2.0
// Plot data for the report of a calibration: the error of each pose, and the predicted error over the workspace.
#pragma once

#include "kinfer/calibrate/problem/task.hpp"
#include "kinfer/evidence/calibration/calibration.hpp"

namespace kinfer::calibrate {

/// `before`: the nominal chain with base and tool refitted. The workspace is sampled at joint positions that cover the
/// ranges of the data evenly (an additive low-discrepancy sequence: deterministic). The predicted errors include the
/// model error of `prediction`.
CalibrationPlotData make_plot_data(const CalibrationTask& task, const Chain& before, const Estimate& estimate,
                                   const std::optional<PredictionModel>& prediction, int threads);

/// [m] rms over the rows of what the model is expected to be off.
double expected_error(const CalibrationPlotData& plot_data);

}  // namespace kinfer::calibrate
