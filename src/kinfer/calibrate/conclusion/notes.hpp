// SPDX-License-Identifier: Apache-2.0
// Notes on a calibration: automatic decisions that the user should know.
#pragma once

#include "kinfer/calibrate/fit/tolerance_fit.hpp"
#include "kinfer/calibrate/validation/gross_errors.hpp"
#include "kinfer/evidence/calibration/calibration.hpp"

namespace kinfer::calibrate {

/// From the estimate and what was decided on the way to it. `nominal` is the chain that the fit started from.
std::vector<CalibrationNote> make_notes(const Estimate& estimate, const Chain& nominal, const ExcludedRows& excluded,
                                        const ToleranceScale& scale, const ParameterChoice& parameters);

}  // namespace kinfer::calibrate
