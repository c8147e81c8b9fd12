// SPDX-License-Identifier: Apache-2.0
// Rows that arrive out of order, because loggers and networks delay them, put back into the order of time.
#pragma once

#include <cstdint>
#include <deque>

#include "kinfer/base/result.hpp"
#include "kinfer/measurement/ins/ins_row.hpp"

namespace kinfer {

/// Holds rows back until none that is at most `longest_delay` late can come before them. Rows of one time become one,
/// each sensor's sample from the row that has it.
class RowOrder {
 public:
  /// [s] not negative; 0: rows pass at once.
  explicit RowOrder(double longest_delay) : longest_delay_(longest_delay) {}

  /// Calls `sink` for each row that is due, in order of time.
  Result<void> add(const InsRow& row, const InsRowSink& sink);

  /// For those that are still held back, after the last.
  Result<void> finish(const InsRowSink& sink);

  /// Rows that were dropped because later ones had been passed on.
  std::int64_t dropped() const { return dropped_; }

 private:
  Result<void> pass_until(double time, const InsRowSink& sink);

  double longest_delay_ = 0.0, newest_ = 0.0, passed_ = 0.0;
  bool has_rows_ = false, has_passed_ = false;
  std::deque<InsRow> waiting_;  // by time
  std::int64_t dropped_ = 0;
};

}  // namespace kinfer
