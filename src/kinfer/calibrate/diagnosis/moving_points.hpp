// SPDX-License-Identifier: Apache-2.0
// Whether measured points move as the joints do.
#pragma once

#include "kinfer/calibrate/problem/task.hpp"

namespace kinfer::calibrate {

/// rms distance of points from their centre [m].
double spread_of(const std::vector<Vec3>& points);
double spread_of(const std::vector<PointMeasurement>& points);

/// One point in all postures is right where the tool was held on it. An error where the nominal model moves the tool by
/// more than its tolerances could feign: the columns repeat one value.
Result<void> expect_moving_points(const CalibrationTask& task);

}  // namespace kinfer::calibrate
