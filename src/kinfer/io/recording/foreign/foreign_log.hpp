// SPDX-License-Identifier: Apache-2.0
// One foreign INS log, read by a column map or by what its header says: several sensors, or an instrument or two of
// one.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/io/recording/foreign/ins_map.hpp"
#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer {

/// Sensors with all or some of their instruments, on the rows of one file.
struct ForeignLog {
  std::string name;                               ///< the file's base name
  std::vector<double> time;                       ///< [s], strictly increasing
  std::vector<InsSensor> sensors;                 ///< without faults; columns of missing instruments are empty
  std::vector<std::array<bool, 3>> stated_units;  ///< of each sensor's instruments
  bool states_time_unit = false;
  std::vector<std::string> remarks;
  bool has_free_acceleration = false;  ///< columns from which gravity is removed; they are not used
};

Result<ForeignLog> parse_foreign_log(std::string_view text, const std::filesystem::path& path, const InsMap& map);

/// Adds the logs as loggers and sensors: instruments of one sensor from several files are put on common rows. An error
/// where a sensor lacks accelerometer or gyroscope, or two files hold the same instrument of a sensor.
Result<void> append_foreign_logs(std::vector<ForeignLog> logs, InsRecording& recording);

}  // namespace kinfer
