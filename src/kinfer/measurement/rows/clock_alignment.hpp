// SPDX-License-Identifier: Apache-2.0
// Sensors whose time stamps are off by a constant, as an identification found it, brought to the time of their rows.
#pragma once

#include <deque>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/measurement/ins/ins_row.hpp"

namespace kinfer {

/// A sample of sensor s stamped t was taken at t + offset[s]. Each row keeps its time and gets, of such a sensor, the
/// samples before and after it, interpolated linearly; none where they are far apart. A row is passed on when the
/// latest sensor has caught up with it: after the largest −offset and one more sample.
class ClockAlignment {
 public:
  /// [s] one for each sensor of the rows; offsets below `least_clock_offset` are none.
  explicit ClockAlignment(const std::vector<double>& offsets);

  /// Whether any sensor is off; rows pass unchanged and at once otherwise.
  bool has_effect() const { return has_effect_; }

  Result<void> add(const InsRow& row, const InsRowSink& sink);

  /// The rows that still wait, after the last.
  Result<void> finish(const InsRowSink& sink);

 private:
  struct Track {
    double offset = 0.0;
    std::deque<InsSample> samples{};  // at the times at which they were taken
  };

  bool is_ready(double time) const;
  void fill(InsRow& row);
  Result<void> pass_ready(bool is_last, const InsRowSink& sink);

  std::vector<Track> tracks_;
  std::deque<InsRow> waiting_;
  bool has_effect_ = false;
};

inline constexpr double least_clock_offset = 2e-4;  ///< [s] as identify names them

}  // namespace kinfer
