// SPDX-License-Identifier: Apache-2.0
// How much noisier each instrument is than its model says, by its leave-one-out innovations: that of an instrument in
// motion which the chain does not explain (flexing segments, soft mounts, impacts) grows within a second. The plain
// innovation does not tell: it is mostly as wide as the accelerations that the state may have.
#pragma once

#include <vector>

#include "kinfer/track/filter/innovations.hpp"

namespace kinfer::track {

class InstrumentLevels {
 public:
  explicit InstrumentLevels(std::size_t sensors) : factor_(sensors, {1.0, 1.0}), ordered_(sensors, 0.0) {}

  /// Factor on the variance of a sensor's gyroscope and accelerometer; at least 1.
  InsLevel of(std::size_t sensor) const { return factor_[sensor]; }
  /// The median over the sensors in use, of the larger one of each: how far the motion is from what the chain explains.
  double common() const { return common_; }

  /// After an update. `is_measured`: of each instrument.
  void adapt(const Innovations& innovations, const std::vector<bool>& is_measured, const std::vector<bool>& is_used);

 private:
  std::vector<InsLevel> factor_;
  double common_ = 1.0;
  std::vector<double> ordered_;  // buffer of medians
};

}  // namespace kinfer::track
