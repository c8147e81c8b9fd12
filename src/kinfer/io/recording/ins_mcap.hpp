// SPDX-License-Identifier: Apache-2.0
// INS recordings as MCAP: topics SENSOR/imu (sensor_msgs/Imu) and SENSOR/magnetic_field (sensor_msgs/MagneticField).
#pragma once

#include <filesystem>

#include "kinfer/base/result.hpp"
#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer {

/// Times are written as they are, in seconds from 1970 on the viewer's clock, to the nanosecond. Missing values are not
/// a number; an instrument that a sensor lacks has −1 as the first number of its covariance.
Result<void> write_ins_mcap(const std::filesystem::path& path, const InsRecording& recording);

}  // namespace kinfer
