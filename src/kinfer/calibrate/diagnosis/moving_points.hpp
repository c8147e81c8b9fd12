// SPDX-License-Identifier: Apache-2.0
// Whether what was measured changes as the joints move.
#pragma once

#include "kinfer/calibrate/problem/task.hpp"

namespace kinfer::calibrate {

/// One point in all postures is right where the tool was held on it, and so is one distance where it was led round an
/// anchor. An error where the nominal model moves the tool by more than its tolerances could feign: the columns repeat
/// one value.
Result<void> expect_moving_points(const CalibrationTask& task);

}  // namespace kinfer::calibrate
