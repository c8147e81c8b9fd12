// SPDX-License-Identifier: Apache-2.0
// Checks that need a full fit: drift of the base, outliers.
#pragma once

#include "kinfer/calibrate/diagnosis/diagnosis_state.hpp"

namespace kinfer::calibrate {

/// Drift or a step of the base over the rows, and rows whose errors exceed any noise.
void check_residuals(DiagnosisState& state);

}  // namespace kinfer::calibrate
