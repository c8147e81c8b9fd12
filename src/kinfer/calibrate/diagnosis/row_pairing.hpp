// SPDX-License-Identifier: Apache-2.0
// Joint positions and measurements that do not belong together: shifted, swapped, or with the base moved in between.
#pragma once

#include "kinfer/calibrate/diagnosis/diagnosis_state.hpp"

namespace kinfer::calibrate {

/// Whether a model was found to evaluate the pairing: a fit to all rows, or to a run of consecutive rows.
enum class PairingEvaluated { yes, no };

/// Corrected rows keep their index: their joint positions are replaced by those that belong to the measurement; a
/// measurement without joint positions is removed.
PairingEvaluated check_pairing(DiagnosisState& state);

}  // namespace kinfer::calibrate
