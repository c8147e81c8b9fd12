// SPDX-License-Identifier: Apache-2.0
// Checks that need a full fit: drift of the base, outliers.
#pragma once

#include <vector>

#include "kinfer/calibrate/diagnosis/diagnosis_state.hpp"
#include "kinfer/evidence/calibration/fit_errors.hpp"

namespace kinfer::calibrate {

/// Drift or a step of the base over the rows, and rows whose errors exceed any noise.
void check_residuals(DiagnosisState& state);

/// The findings once a model is chosen, whose outliers (rows of the data) are given: rows that geometry alone does not
/// explain and the model does are no gross errors.
std::vector<Finding> findings_left_by(std::vector<Finding> findings, std::vector<Outlier> outliers);

}  // namespace kinfer::calibrate
