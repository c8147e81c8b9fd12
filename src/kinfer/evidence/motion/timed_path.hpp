// SPDX-License-Identifier: Apache-2.0
// A path sampled in time, and what is wrong with it.
#pragma once

#include <optional>
#include <vector>

#include "kinfer/evidence/motion/reach_solution.hpp"
#include "kinfer/linalg/types.hpp"

namespace kinfer {

/// One sample a column; all joints.
struct TimedPath {
  std::vector<double> time{};                 ///< [s]
  MatrixXd position, velocity, acceleration;  ///< [rad] or [m], per s, per s²
  double duration = 0.0;                      ///< [s]
  std::vector<double> passing_times{};        ///< [s] at each waypoint
  std::vector<double> cuts{};                 ///< by which each corner is cut, in the unit of the path's options
  double slowed_by = 1.0;                     ///< straight lines of the tool: factor by which the joints slow it down
};

/// The first place at which a path cannot be driven.
struct PathObstacle {
  enum class Kind {
    outside_limits,  ///< a joint leaves its limits
    near_singular,   ///< a line of the tool passes a singular posture
    not_reached,     ///< a point of a line of the tool has no posture near the one before it
  };
  Kind kind = Kind::not_reached;
  double time = 0.0;  ///< [s]
  int line = 0;       ///< from 0
  int joint = -1;     ///< index into q; outside_limits
};

struct PathResult {
  TimedPath path{};
  std::optional<PathObstacle> obstacle{};
  std::vector<ReachSolution> targets{};  ///< of a path along tool lines with an obstacle: each target by itself
};

}  // namespace kinfer
