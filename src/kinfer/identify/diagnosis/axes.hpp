// SPDX-License-Identifier: Apache-2.0
// Unit, sense and axes of each gyroscope against the accelerometer and the magnetometer of the same sensor.
#pragma once

#include "kinfer/base/result.hpp"
#include "kinfer/identify/diagnosis/mended_log.hpp"

namespace kinfer::identify {

/// An error if the gyroscope's columns hold Euler angles.
Result<void> refuse_attitudes(const InsRecording& recording);

/// The unit of the rates is one for the log, unless sensors contradict each other. Other axes are mapped to those of
/// the accelerometer: any axes that the instruments share are as good, since mountings are unknown.
void mend_axes(MendedLog& log, int threads);

/// "x, -z, y": row by row of a permutation with signs.
std::string describe_axes(const Mat3& axes);

}  // namespace kinfer::identify
