// SPDX-License-Identifier: Apache-2.0
// How a sensor that was named as moved is mounted since. A sensor that stays turned about a hinge agrees with the
// others again after a while, because its neighbours' positions become uncertain without it: that it agrees says
// nothing then. A filter of its own, from before the fault on, uses the sensor with an unknown turn of its mounting;
// while that explains its samples, the turn tells whether the mounting is the original one.
#pragma once

#include <optional>

#include "kinfer/track/faults/fit_monitor.hpp"
#include "kinfer/track/faults/mount_turn.hpp"

namespace kinfer::track {

class TurnedMount {
 public:
  /// `before`: some seconds before it was named; `rows` since. It was turned at some time in between, `log_odds` being
  /// those of the turn by which it was named: what a change shows at once is lost in how uncertain the mounting is.
  TurnedMount(const ChainFilter& before, std::span<const BlockMeasurement> rows, std::size_t sensor, double log_odds);
  /// It may be turned already; `without`: the filter without the sensor.
  TurnedMount(const ChainFilter& without, std::size_t sensor);

  /// After each update of the filter `without` the sensor. Where the mounting has changed again, its turn is unknown
  /// again.
  void add(const BlockMeasurement& block, const ChainFilter& without);

  /// The filter with the sensor as it is mounted.
  ChainFilter& filter() { return filter_; }
  double time() const { return filter_.state().time; }  ///< [s]

  /// By how much its samples are likelier if it is mounted as it was than if it is turned, ln. None where it moved
  /// again while nothing else showed the position beside it.
  std::optional<double> log_odds_of_original() const;

 private:
  void begin(const ChainFilter& without);
  void update(const BlockMeasurement& block);

  std::size_t sensor_;
  MountTurn original_, supposed_;  // supposed: before its samples since the change
  ChainFilter filter_;
  FitMonitor fit_;
  double log_odds_;  // of the turn, before it was watched
  bool is_known_ = true;
};

}  // namespace kinfer::track
