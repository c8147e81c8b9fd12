// SPDX-License-Identifier: Apache-2.0
// How uncertain a machine is while several starts are possible: the mean squared distance of all of them from the one
// that is stated,
//   σ² = Σ p_c (σ_c² + (x_c − x)²)
#pragma once

#include "kinfer/evidence/tracking/track_state.hpp"
#include "kinfer/evidence/tracking/tracking_model.hpp"
#include "kinfer/track/readout/tool_spread.hpp"
#include "kinfer/track/start/start_grid.hpp"

namespace kinfer::track {

class StartSpread {
 public:
  StartSpread(const TrackingModel& model, const FilterModel& filter);

  /// `unknown`: of each body, as of ToolSpread.
  void update(const StartGrid& grid, std::span<const double> unknown);
  void clear();

  /// To the standard deviations of the start that is stated.
  void add_to(TrackState& state) const;

 private:
  void read(const ChainFilter& filter, std::span<const double> unknown, TrackState& to);
  void add(const TrackState& one, const TrackState& stated, double probability);

  TrackingModel model_;
  ToolSpread tool_;
  Eigen::ArrayXd q_, qd_;
  Eigen::Array3d base_, tool_position_, tool_rotation_;
  std::vector<bool> turns_;  // of each joint position
  TrackState stated_, one_;  // buffers
};

}  // namespace kinfer::track
