// SPDX-License-Identifier: Apache-2.0
// The verdict of a calibration: whether to use it, and why.
#pragma once

#include "kinfer/evidence/calibration/calibration.hpp"

namespace kinfer::calibrate {

/// The reason of the verdict, from the error statistics of the calibration and what it expects of held-out rows: an
/// effect is not modelled where the measured errors, or those that the prediction model expects
/// (`predicted_holdout_rms`), are far above those of instrument and fit (`expected_holdout_rms`). A robot without a
/// data sheet has no earlier model to be compared with: its held-out errors are compared with those of the fitted rows.
CalibrationReason judge(const Calibration& calibration);

/// `do_not_use` where the calibration neither improves the nominal model nor generalises; `use_with_care` where the
/// improvement is not proven, the errors exceed what the instrument explains, the robot is far from its nominal model,
/// or no length was measured; else `use`.
Usability usability_of(CalibrationReason reason, const std::optional<UnobservedLengths>& unobserved = {});

}  // namespace kinfer::calibrate
