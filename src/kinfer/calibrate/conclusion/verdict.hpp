// SPDX-License-Identifier: Apache-2.0
// The verdict of a calibration: its accuracy before and after, and whether to use it.
#pragma once

#include <optional>

#include "kinfer/evidence/calibration.hpp"

namespace kinfer::calibrate {

/// Fills `use` and `verdict` from the other members. `expected`: rms error of the held-out rows expected from the
/// instrument's noise and the model's uncertainty [m]; nothing where the instrument is not known.
void write_verdict(Calibration& calibration, std::optional<double> expected);

}  // namespace kinfer::calibrate
