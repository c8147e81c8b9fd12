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

  void add(const BlockMeasurement& block, const ChainFilter& filter);
  /// The innovations say that it moves.
  void suspect() {
    if (!is_given_) mode_ = BaseMode::moving;
  }
  BaseMode mode() const { return mode_; }

 private:
  bool is_given_;
  BaseMode mode_;
  int sensor_;
  double noise_ = 0.0;  // [rad/s] of the averaged rate
  Vec3 rate_ = Vec3::Zero();
  double seen_ = 0.0;  // [s]
};

}  // namespace kinfer::track
