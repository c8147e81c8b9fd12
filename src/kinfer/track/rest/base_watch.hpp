// SPDX-License-Identifier: Apache-2.0
// Whether the base moves, from its own sensor: angular velocities beyond bias and noise, and gravity that changes.
#pragma once

#include <optional>

#include "kinfer/track/filter/chain_filter.hpp"

namespace kinfer::track {

class BaseWatch {
 public:
  /// `given`: by the user; none: by the sensor of the base.
  BaseWatch(const TrackingModel& model, const FilterModel& filter, std::optional<BaseMode> given);

  void add(const BlockMeasurement& block, const ChainFilter& filter);
  /// Sensors disagree: less motion of the base is needed to put it down to that.
  void suspect(const ChainFilter& filter);
  BaseMode mode() const { return mode_; }

 private:
  void judge(const ChainFilter& filter, double share);

  bool is_given_;
  BaseMode mode_;
  int sensor_;
  double noise_ = 0.0;        // [rad/s] of the averaged rate
  Vec3 rate_ = Vec3::Zero();  // [rad/s] measured, averaged
  double seen_ = 0.0;         // [s]
};

}  // namespace kinfer::track
