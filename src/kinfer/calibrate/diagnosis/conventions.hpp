// SPDX-License-Identifier: Apache-2.0
// Units, signs, offsets and columns that disagree with the robot file: each is tested as a hypothesis, and accepted if
// base and tool alone then explain the points.
#pragma once

#include "kinfer/calibrate/diagnosis/diagnosis_state.hpp"

namespace kinfer::calibrate {

/// Tests units, joint signs, zero offsets, swapped columns, coupled joints and handedness; corrects what is certain.
void check_conventions(DiagnosisState& state);

}  // namespace kinfer::calibrate
