// SPDX-License-Identifier: Apache-2.0
// The header of an INS recording, interpreted: the time column, and sensor, instrument, axis and unit of the others.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/io/text/csv.hpp"
#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer {

struct InsColumn {
  std::optional<std::size_t> sensor;  ///< index in the recording; empty for the time and for unused columns
  std::size_t instrument = 0;         ///< 0 specific force, 1 angular rate, 2 magnetic field
  std::size_t axis = 0;               ///< 0 x, 1 y, 2 z
  double factor = 1.0;                ///< SI (µT) per unit of the file
};

struct InsColumns {
  std::vector<InsColumn> columns;  ///< one per column of the header
  std::size_t time_column = 0;
  std::vector<std::array<bool, 3>> has_unit;  ///< one per sensor of this file: its instruments' units are stated
  std::vector<std::string> unused_columns;    ///< names of columns that are not INS channels
};

/// Adds the file's logger and sensors (without rows) to `out`. Errors: an incomplete triad, a sensor without
/// accelerometer or gyroscope, a unit that is unknown or of the wrong dimension, a sensor that another file has too.
Result<InsColumns> parse_ins_columns(const CsvHeader& header, const std::string& name_in_messages, InsRecording& out);

/// Whether the header is that of an INS recording: t and at least one accelerometer or gyroscope column.
bool is_ins_csv(std::string_view text);

}  // namespace kinfer
