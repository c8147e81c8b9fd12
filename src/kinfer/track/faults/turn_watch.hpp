// SPDX-License-Identifier: Apache-2.0
// Sensors that turn at once by less than their noise shows in a block. The scores of a turn add up while innovations
// are white. What geometry, instruments and soft mounts are off by is there before as well, so that only what stands
// out from the last minute counts; it is examined a while later, when it has shown whether it lasts.
#pragma once

#include <optional>
#include <vector>

#include "kinfer/track/faults/usual_peak.hpp"
#include "kinfer/track/filter/chain_filter.hpp"

namespace kinfer::track {

class TurnWatch {
 public:
  explicit TurnWatch(std::size_t sensors) : turns_(sensors) {}

  /// After an update of `filter` that stands for `length` [s].
  void add(const ChainFilter& filter, double time, double length);
  void reset();

  /// [s] When a change was noticed that is to be examined now.
  std::optional<double> noticed(double time) const;
  /// Whether the sensor has shown about as much of it as that which showed most.
  bool may_have_turned(std::size_t sensor) const { return turns_[sensor].most > share_of_most * most_; }
  /// It was examined: what is noticed within the next seconds is the same.
  void settle(double time);

 private:
  static constexpr double share_of_most = 0.5;
  struct Turn {
    TurnScore sum{};    // forgotten over turn_mean
    double most = 0.0;  // since the change was noticed
  };

  std::vector<Turn> turns_;
  double most_ = 0.0;                            // of all sensors
  UsualPeak usual_;                              // of that
  std::optional<double> noticed_{}, settled_{};  // [s]; settled: a change was examined last
};

}  // namespace kinfer::track
