// SPDX-License-Identifier: Apache-2.0
// Tracks a machine on its identified chain, row by row: joint positions and velocities, base attitude and tool pose
// with standard deviations, from gyroscopes and accelerometers.
#pragma once

#include "kinfer/evidence/tracking/track_state.hpp"
#include "kinfer/evidence/tracking/tracking_model.hpp"
#include "kinfer/track/options.hpp"

namespace kinfer::track {

/// Copyable; no allocation in add() once it has started.
class Tracker {
 public:
  explicit Tracker(const TrackingModel& model, const TrackOptions& options = {});

  /// Processes the next row.
  void add(const InsRow& row);

  /// At the time of the last row.
  const TrackState& state() const { return state_; }

 private:
  TrackState state_;
};

}  // namespace kinfer::track
