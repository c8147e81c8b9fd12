// SPDX-License-Identifier: Apache-2.0
// The verdict of a calibration: whether to use it, and why.
#pragma once

#include "kinfer/evidence/calibration/calibration.hpp"

namespace kinfer::calibrate {

/// The reason of the verdict, from the error statistics and `expected_holdout_rms` of the calibration. A robot without
/// a data sheet has no earlier model to be compared with: its held-out errors are compared with those of the fitted
/// rows.
CalibrationReason judge(const Calibration& calibration);

/// `use` where the calibration improves the nominal model or generalises, else `do_not_use`.
Usability usability_of(CalibrationReason reason);

}  // namespace kinfer::calibrate
