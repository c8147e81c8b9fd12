// The sentence on top of a calibration: how good, against what, and whether to use it.
#pragma once

#include <optional>

#include "kinfer/evidence/calibration.hpp"

namespace kinfer {

/// Fills `use` and `verdict` from the rest. `instrument_scatter`: rms distance of a measured point from the truth that the
/// instrument promises [m]; nothing where the instrument is not known.
void judge(Calibration& calibration, std::optional<double> instrument_scatter);

}  // namespace kinfer
