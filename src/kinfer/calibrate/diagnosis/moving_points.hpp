// SPDX-License-Identifier: Apache-2.0
// Whether what was measured changes as the joints move.
#pragma once

#include <span>

#include "kinfer/base/result.hpp"
#include "kinfer/calibrate/problem/task.hpp"

namespace kinfer::calibrate {

/// Standard deviations of points along the principal axes of their cloud [m], ascending.
Vec3 principal_spread(std::span<const Vec3> points);

/// One point in all postures is right where the tool was held on it, and so is one distance where it was led round an
/// anchor, or one direction where it came along the line of sight. An error where the nominal model moves the tool by
/// more than its tolerances could feign: the columns repeat one value. So it is where the points stay in a plane or on
/// a line out of which the nominal model moves the tool.
Result<void> expect_moving_points(const CalibrationTask& task);

}  // namespace kinfer::calibrate
