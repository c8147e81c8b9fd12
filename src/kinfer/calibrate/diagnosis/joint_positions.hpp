// SPDX-License-Identifier: Apache-2.0
// Checks without a fit: poorly excited joints, joint limits, copied rows, targets that are not rigid on the tool.
#pragma once

#include "kinfer/calibrate/diagnosis/diagnosis_state.hpp"

namespace kinfer::calibrate {

void check_joint_positions(DiagnosisState& state);
void check_duplicate_rows(DiagnosisState& state);
void check_target_rigidity(DiagnosisState& state);

}  // namespace kinfer::calibrate
