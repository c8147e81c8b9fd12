// SPDX-License-Identifier: Apache-2.0
// Sensors that measure again after joints beside them have moved unseen. Such a position may be anywhere, and one
// linearisation of what the sensor shows holds for small angles only: taken in by an update, a sound sensor disagrees
// from then on. The filter without them goes on for a moment; then the position is sought on the circle, from the
// filter as it was when they came back, by an iterated extended Kalman filter over the rows since (Bell and Cathey
// 1993), and the most likely place is taken. All other states stay as they are.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "kinfer/track/filter/chain_filter.hpp"

namespace kinfer::track {

/// A revolute position of the filter, how well it is known after that, and whether one place is the likeliest by far.
struct FoundPosition {
  Index position = 0;
  double sd = 0.0;  ///< [rad]
  bool is_decided = false;
};

struct FoundAgain {
  ChainFilter filter;  ///< at the last of the rows, with the sensor
  std::vector<FoundPosition> positions{};
};

/// `before`: the filter before the rows, without the sensor.
FoundAgain find_again(const ChainFilter& before, std::span<const BlockMeasurement> rows, std::size_t sensor);

/// Whether a revolute position beside the sensor is so uncertain that it must be sought.
bool has_lost_position(const ChainFilter& filter, std::size_t sensor);

/// Waits for the rows of sensors that have come back: one after the other, those nearer to the base first.
class SensorReturn {
 public:
  bool is_waiting() const { return !sensors_.empty(); }
  bool waits_for(std::size_t sensor) const;

  /// `filter`: at the last row without it.
  void begin(std::size_t sensor, const ChainFilter& filter);
  /// It is lost again.
  void drop(std::size_t sensor, const ChainFilter& filter);
  /// From here on, with what was judged anew.
  void begin_again(const ChainFilter& filter);
  void reset();

  /// After each update of the filter without the sensors. Where the next one's positions are found, or will not be; the
  /// others wait on from `begin_again`.
  std::optional<FoundAgain> add(const BlockMeasurement& block);

 private:
  std::vector<std::size_t> sensors_;
  std::optional<ChainFilter> before_;
  std::vector<BlockMeasurement> rows_;
  double tried_ = 0.0;  // [s] of rows
};

}  // namespace kinfer::track
