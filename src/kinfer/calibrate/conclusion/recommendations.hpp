// SPDX-License-Identifier: Apache-2.0
// Recommendations after a calibration: what to measure or to do next.
#pragma once

#include <vector>

#include "kinfer/calibrate/problem/task.hpp"
#include "kinfer/evidence/calibration/calibration.hpp"

namespace kinfer::calibrate {

/// Most useful first. The calibration's usability and plot data must be there.
std::vector<CalibrationAdvice> make_recommendations(const CalibrationTask& task, const Calibration& calibration);

}  // namespace kinfer::calibrate
