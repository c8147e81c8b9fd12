// SPDX-License-Identifier: Apache-2.0
// Whether a sensor's samples come late: measurements that are those of a time τ earlier differ from the prediction by
// −ż τ. The leave-one-out innovations' score and information of τ, forgotten over a while, tell it and how much of the
// disagreement it explains.
#pragma once

#include <algorithm>

#include "kinfer/track/filter/chain_filter.hpp"

namespace kinfer::track {

class ClockWatch {
 public:
  explicit ClockWatch(std::size_t sensors) : clocks_(sensors) {}

  /// After an update of `filter` that stands for `length` [s].
  void add(const ChainFilter& filter, double length);

  /// Its lateness explains more than `share` of the sensor's disagreement.
  bool is_late(std::size_t sensor, double share) const;
  /// [s]
  double lateness(std::size_t sensor) const { return clocks_[sensor].score / clocks_[sensor].information; }
  void reset() { std::ranges::fill(clocks_, Clock{}); }

 private:
  struct Clock {
    double score = 0.0, information = 0.0;  // of τ [1/s], [1/s²]
    double excess = 0.0;                    // of T over its expectation
  };
  std::vector<Clock> clocks_;
};

}  // namespace kinfer::track
