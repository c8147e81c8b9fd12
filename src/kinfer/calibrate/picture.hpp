// What a report draws of a calibration: where each pose was off, and how sure the model is where.
#pragma once

#include "kinfer/calibrate/calibrate.hpp"

namespace kinfer {

/// `before`: the nominal chain with base and tool refitted. The workspace is sampled at joint readings that fill the
/// ranges of the data evenly (an additive low-discrepancy sequence: no randomness).
CalibrationPicture calibration_picture(const CalibrateTask& task, const Chain& before, const Estimate& estimate);

/// What to do next, most useful first.
std::vector<Advice> calibration_advice(const CalibrateTask& task, const Calibration& calibration);

}  // namespace kinfer
