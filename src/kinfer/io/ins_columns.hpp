// What the header of an INS recording means: which column is the time, and which are whose channels in which unit.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/io/csv.hpp"
#include "kinfer/measurement/ins_recording.hpp"

namespace kinfer {

struct InsColumn {
  std::optional<std::size_t>
      sensor;                  ///< index in the recording; nothing for the time and for columns that are not used
  std::size_t instrument = 0;  ///< 0 specific force, 1 angular rate, 2 magnetic field
  std::size_t axis = 0;        ///< 0 x, 1 y, 2 z
  double factor = 1.0;         ///< SI (µT) per unit of the file
};

struct InsColumns {
  std::vector<InsColumn> columns;  ///< one a column of the header
  std::size_t time_column = 0;
  std::vector<bool> field_has_unit;   ///< one a sensor of this file: its magnetometer's unit is stated
  std::vector<std::string> not_used;  ///< names of columns that are no INS channel
};

/// Adds the file's logger and sensors (without rows) to `out`. A sensor with half a triad, or without accelerometer or
/// gyroscope, a unit that is unknown or of the wrong dimension, and a sensor that another file has too are errors.
Result<InsColumns> understand_ins_columns(const CsvHeader& header, const std::string& name_in_messages,
                                          InsRecording& out);

}  // namespace kinfer
