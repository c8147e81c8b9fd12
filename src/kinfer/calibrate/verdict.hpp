// The sentence on top of a calibration: how good, against what, and whether to use it.
#pragma once

#include <optional>

#include "kinfer/evidence/calibration.hpp"

namespace kinfer {

/// Fills `use` and `verdict` from the rest. `expected`: rms error that instrument and model uncertainty together
/// let the held-out rows show [m]; nothing where the instrument is not known.
void judge(Calibration& calibration, std::optional<double> expected);

}  // namespace kinfer
