// SPDX-License-Identifier: Apache-2.0
// A user-defined sensor grade: tables [accelerometer], [gyroscope], [magnetometer] with the figures of a data sheet.
//
//   name = "my sensor"
//   units = { acceleration = "g", angular_rate = "deg/s", magnetic_field = "uT" }
//   [gyroscope]
//   noise_density = 0.005        # per √Hz
//   bias = 0.1                   # one sigma of the constant bias; magnetometer: hard iron
//   instability = 0.002          # one sigma of the drifting bias (Gauss-Markov), and its correlation time:
//   instability_time = 100       # [s]
//   scale = 5e-4                 # one sigma of scale and cross-axis terms; magnetometer: soft iron
//   range = 2000
//   resolution = 0.0153
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "kinfer/base/result.hpp"
#include "kinfer/measurement/sensor_model.hpp"

namespace kinfer {

Result<SensorModel> parse_sensor_grade(std::string_view text, const std::string& name_in_messages);
Result<SensorModel> read_sensor_grade(const std::filesystem::path& path);

/// In SI units (µT); parse_sensor_grade reads back the same model.
std::string format_sensor_grade(const SensorModel& model);

}  // namespace kinfer
