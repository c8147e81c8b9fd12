// SPDX-License-Identifier: Apache-2.0
// From a nominal model and external measurements to a corrected model, validated on held-out poses.
#pragma once

#include "kinfer/base/observer.hpp"
#include "kinfer/base/result.hpp"
#include "kinfer/base/rng.hpp"
#include "kinfer/calibrate/problem/options.hpp"
#include "kinfer/calibrate/problem/task.hpp"
#include "kinfer/evidence/calibration/calibration.hpp"

namespace kinfer::calibrate {

/// An error where the data are too few, or contradict the robot or the options.
Result<Calibration> calibrate_robot(const CalibrationTask& task, const CalibrationOptions& options, Rng rng,
                                    const Observer& observer = {});

}  // namespace kinfer::calibrate
