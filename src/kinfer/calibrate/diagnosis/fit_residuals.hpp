// SPDX-License-Identifier: Apache-2.0
// Checks that need a full fit: joint positions recorded while the arm moved, drift of the base, outliers.
#pragma once

#include "kinfer/calibrate/diagnosis/diagnosis_state.hpp"

namespace kinfer::calibrate {

/// Compares commanded and measured joint positions; the data keep those that explain the points better.
void check_commanded_positions(DiagnosisState& state);

/// Drift or a step of the base over the rows, and rows whose errors exceed any noise.
void check_residuals(DiagnosisState& state);

}  // namespace kinfer::calibrate
