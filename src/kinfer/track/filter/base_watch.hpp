// SPDX-License-Identifier: Apache-2.0
// Whether the base moves, from its own sensor: angular velocities beyond bias and noise, and gravity that changes.
#pragma once

#include <optional>

#include "kinfer/track/filter/chain_filter.hpp"

namespace kinfer::track {

class BaseWatch {
 public:
  /// `given`: by the user; none: the base's sensor tells.
  BaseWatch(const TrackingModel& model, const FilterModel& filter, std::optional<BaseMode> given);

  void add(const BlockMeasurement& block, const ChainState& state);
  BaseMode mode() const { return mode_; }

 private:
  bool is_given_;
  BaseMode mode_;
  int sensor_;
  double rate_limit_ = 0.0;  // [rad/s]
  Vec3 rate_ = Vec3::Zero();
  double seen_ = 0.0;  // [s]
};

}  // namespace kinfer::track
