// SPDX-License-Identifier: Apache-2.0
// What does not fit wherever a joint stands: while a grid of starts is open, a wrong place looks like a fault of the
// sensors beside the joint, but each place calls another one so, or none.
#pragma once

#include <vector>

#include "kinfer/track/faults/fit_monitor.hpp"
#include "kinfer/track/start/start_grid.hpp"

namespace kinfer::track {

class PlaceFits {
 public:
  PlaceFits(std::size_t sensors, std::size_t joints) : untold_(sensors, joints) {}

  /// After each update of the grid.
  void add(const StartGrid& grid, double time, double length);
  void reset() { fits_.clear(); }

  /// That in which all places that are left agree.
  Suspect common(const StartGrid& grid) const;

 private:
  FitMonitor untold_;
  std::vector<FitMonitor> fits_;  // of each place of the grid as it began
};

}  // namespace kinfer::track
