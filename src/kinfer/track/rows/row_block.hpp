// SPDX-License-Identifier: Apache-2.0
// Rows gathered into one measurement for the filter: their mean at their mean time. The mean keeps the information of
// every row, and is an anti-alias filter for vibration; a single row of them would waste half of the accuracy.
#pragma once

#include <array>
#include <span>

#include "kinfer/measurement/ins/ins_row.hpp"
#include "kinfer/track/filter/chain_filter.hpp"
#include "kinfer/track/model/thresholds.hpp"

namespace kinfer::track {

class RowBlock {
 public:
  explicit RowBlock(std::size_t sensors);

  void add(const InsRow& row);
  void clear();

  int rows() const { return rows_; }
  double begin() const { return begin_; }  ///< [s] time of the first row

  /// Where another row, a sampling period later, would make it longer than `length` [s]. The first row beyond a gap is
  /// complete alone: what is stated at its time must not be older than the gap.
  bool is_complete(double length) const;

  /// Until the next call of add or clear.
  const BlockMeasurement& mean();

  /// A row at `time` [s] is beyond a gap: its mean with these rows would be that of no time.
  bool ends_before(double time) const;
  /// [s] that it stands for; 0: one row, of unknown sampling period.
  double length() const { return end_ - begin_ + period_; }

 private:
  bool is_beyond_gap(double time) const;
  void follow_period(double step);

  BlockMeasurement sum_, mean_;
  int rows_ = 0;
  bool stands_alone_ = false, has_rows_ = false;  // the second: in any block
  double begin_ = 0.0, end_ = 0.0, period_ = 0.0;
  std::array<double, period_steps> steps_{};  // [s] between the last rows, of this block or not, in a ring
  std::size_t step_count_ = 0;                // of all rows
};

/// One block of several in a row: means weighed by their number of rows.
BlockMeasurement mean_of(std::span<const BlockMeasurement> blocks);

}  // namespace kinfer::track
