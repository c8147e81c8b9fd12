// SPDX-License-Identifier: Apache-2.0
// Which of the sensors that are out of use because they disagree are mounted as they were, and which are turned.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "kinfer/track/faults/turned_mount.hpp"

namespace kinfer::track {

class MountWatch {
 public:
  explicit MountWatch(std::size_t sensors) : mounts_(sensors) {}

  /// The sensor was left out: it was turned at some time in `rows`, with these log-odds against no turn; `before`: the
  /// filter before them.
  void begin(std::size_t sensor, const ChainFilter& before, std::span<const BlockMeasurement> rows, double log_odds);
  /// After each update of `filter`; `is_watched`: whether a sensor is out of use because it disagrees, and measures.
  void add(const BlockMeasurement& block, const ChainFilter& filter,
           const std::function<bool(std::size_t)>& is_watched);
  /// What the filters of the turns have believed turned out to be wrong.
  void reset();
  /// Corrects the filter of each turn.
  void correct(const std::function<void(ChainFilter&)>& correction);

  /// One that agrees, but may be turned for all that is known, stays out of use.
  bool may_return(std::size_t sensor) const;
  bool is_turned(std::size_t sensor) const;

 private:
  std::optional<double> log_odds_of_original(std::size_t sensor) const;

  std::vector<std::optional<TurnedMount>> mounts_;
};

}  // namespace kinfer::track
