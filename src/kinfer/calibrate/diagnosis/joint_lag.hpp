// SPDX-License-Identifier: Apache-2.0
// Joint positions that are not those of the measured tool: commanded or measured ones, read too early or too late.
#pragma once

#include "kinfer/calibrate/diagnosis/diagnosis_state.hpp"

namespace kinfer::calibrate {

/// Compares commanded and measured joint positions by a fit to each; the data keep those that the points agree with.
void check_commanded_positions(DiagnosisState& state);

/// Residuals along the motion from the row before, or to the next one.
void check_joint_lag(DiagnosisState& state);

}  // namespace kinfer::calibrate
