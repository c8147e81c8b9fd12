// SPDX-License-Identifier: Apache-2.0
// Whether the corrected robot still moves as the nominal one does.
#pragma once

#include "kinfer/calibrate/problem/task.hpp"

namespace kinfer::calibrate {

/// How far the tool of `corrected` moves over how far that of `nominal` does, along the direction in which it lost
/// most [1]: the principal deviations of both clouds of tool points are compared in their order. Only directions in
/// which the nominal tool moves by more than the tolerances could feign count; 1 where there is none. Joint positions
/// are those of the rows, each joint's from another row: poses that touch one socket do not move the tool of the best
/// of robots.
double least_motion(const CalibrationTask& task, const Chain& nominal, const Chain& corrected);

}  // namespace kinfer::calibrate
