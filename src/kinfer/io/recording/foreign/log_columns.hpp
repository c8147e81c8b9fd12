// SPDX-License-Identifier: Apache-2.0
// Which columns of a foreign log are used, and as what.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/io/recording/foreign/ins_map.hpp"

namespace kinfer {

struct LogColumn {
  std::size_t index = 0;       ///< in the table
  std::string sensor;          ///< empty: the file's
  std::size_t instrument = 0;  ///< 0 specific force, 1 angular rate, 2 magnetic field
  std::size_t axis = 0;
  double factor = 1.0;  ///< SI (µT) per unit of the file
  bool has_unit = false;
};

struct ClockColumn {
  std::optional<std::size_t> index;  ///< in the table
  double tick = 1.0;                 ///< [s] of one count
  bool states_unit = false;          ///< the header, or the map, says how long a count is
};

struct LogColumns {
  std::vector<LogColumn> channels;
  ClockColumn clock, counter;
  bool has_free_acceleration = false;
  bool counts_rows = false;  ///< the row's number is the counter: there is no column of times
};

/// By the map's columns, or by the header where the map names none.
Result<LogColumns> find_log_columns(const CsvHeader& header, std::string_view preamble, const InsMap& map,
                                    const std::string& name);

}  // namespace kinfer
