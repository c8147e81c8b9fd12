// SPDX-License-Identifier: Apache-2.0
// What a statistic has reached at most in the last minute, but for the last seconds: what a machine shows all the time
// is no fault, however much of it there is.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "kinfer/track/faults/thresholds.hpp"

namespace kinfer::track {

class UsualPeak {
 public:
  void add(double value, double time) {
    if (!begin_) begin_ = since_ = time;
    now_ = std::max(now_, value);
    time_ = time;
    const double length = time - since_;
    if (length < peak_length) return;
    usual_ = std::max(usual_ * std::exp(-length / peak_memory), recent_);
    recent_ = now_;
    now_ = 0.0;
    since_ = time;
  }

  /// None before it has been seen for a while.
  std::optional<double> value() const {
    if (!begin_ || time_ - *begin_ < long_mean) return {};
    return usual_;
  }

 private:
  double usual_ = 0.0, recent_ = 0.0, now_ = 0.0;  // until the last seconds, in the last ones, in these
  double since_ = 0.0, time_ = 0.0;                // [s] these began; of the last value
  std::optional<double> begin_{};                  // [s]
};

}  // namespace kinfer::track
