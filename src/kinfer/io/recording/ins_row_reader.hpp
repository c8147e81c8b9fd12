// SPDX-License-Identifier: Apache-2.0
// An INS log read row by row as its bytes arrive, in pieces of any size: a file that still grows, or standard input.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/io/recording/ins_columns.hpp"
#include "kinfer/measurement/ins/ins_row.hpp"

namespace kinfer {

enum class RowTimes {
  increasing,  ///< a row that is not later than the one before is an error
  any          ///< rows come late: somebody else puts them in order
};

/// The same rows, remarks and errors for every way of cutting the text into pieces.
class InsRowReader {
 public:
  using Sink = InsRowSink;

  /// `sensors`: whose samples a row holds, in this order. An error if the log lacks one of them.
  InsRowReader(std::vector<std::string> sensors, std::string name_in_messages, RowTimes times = RowTimes::increasing);

  /// Calls `sink` for each row that is complete.
  Result<void> add(std::string_view bytes, const Sink& sink);

  /// After the last bytes: a last line without an end counts only if it is whole.
  Result<void> finish(const Sink& sink);

  /// So far; one sentence each.
  const std::vector<std::string>& remarks() const { return remarks_; }

 private:
  struct Target {
    int sensor = -1;  ///< into the row; −1: the time, or an unused column
    std::size_t instrument = 0, axis = 0;
    double factor = 1.0;
  };

  Result<void> add_line(std::string_view line, const Sink& sink, bool is_last);
  Result<void> read_header(const std::string& line);
  Result<void> read_row(std::string_view line, const Sink& sink, bool is_last);
  Result<void> check_time(double time);
  Result<void> check_first_times() const;
  Result<void> check_gravity();

  std::vector<std::string> sensors_, remarks_;
  std::string name_, partial_, head_;
  RowTimes times_;
  std::optional<InsColumns> columns_;
  CsvHeader header_;
  std::vector<Target> targets_;
  InsRow row_;
  std::vector<std::array<Vec3, 3>> values_;
  /// Sum of |f| over the first rows.
  struct Gravity {
    double sum = 0.0;
    int rows = 0;
  };
  std::vector<Gravity> gravity_;     // of each sensor
  std::vector<double> first_times_;  // [s]
  int line_ = 0, rows_ = 0;
};

}  // namespace kinfer
