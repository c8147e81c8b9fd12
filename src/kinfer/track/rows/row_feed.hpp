// SPDX-License-Identifier: Apache-2.0
// Rows as a tracker takes them: in order of time, and each sensor's clock corrected as the identification found it.
#pragma once

#include "kinfer/evidence/tracking/tracking_model.hpp"
#include "kinfer/measurement/rows/clock_alignment.hpp"
#include "kinfer/measurement/rows/row_order.hpp"

namespace kinfer::track {

class RowFeed {
 public:
  /// `longest_delay` [s]: rows may come so much too late; 0: they come in order.
  RowFeed(const TrackingModel& model, double longest_delay);

  /// Calls `sink` for each row that is due: at once where rows come in order and no clock is off.
  Result<void> add(const InsRow& row, const InsRowSink& sink);

  /// For the rows that wait, after the last.
  Result<void> finish(const InsRowSink& sink);

  /// Rows that came too late and were dropped.
  std::int64_t dropped() const { return order_.dropped(); }

 private:
  RowOrder order_;
  ClockAlignment clocks_;
};

}  // namespace kinfer::track
