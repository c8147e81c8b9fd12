// SPDX-License-Identifier: Apache-2.0
// How fast a path goes round its waypoints: a speed for each corner, chosen for the shortest time.
//
// At a corner the velocities of all joints change from along one line to along the next by one S ramp, centred on the
// waypoint. The choice is made among stops and speeds in geometric steps by dynamic programming (Bellman 1957). What
// a smaller corner allows, a larger one allows too, and stops are always allowed: so the time never grows with the
// corner, and never exceeds that with a stop at each waypoint.
#pragma once

#include <vector>

#include "kinfer/motion/line_profile.hpp"

namespace kinfer::motion {

/// A stop unless it has speeds.
struct Corner {
  double before = 0.0,
         after = 0.0;  ///< speeds along the two lines where the ramp begins and ends [parts of them per s]
  SRamp ramp{};
  double cut = 0.0;  ///< in the joint that misses the waypoint most, in its unit
};

/// Of each waypoint; stops at the first and the last. Neighbours of `waypoints`, dof x n, n >= 2, differ. No joint
/// misses a waypoint by more than `most_cut` of its `units` [rad] or [m].
std::vector<Corner> quickest_corners(const MatrixXd& waypoints, const std::vector<MotionLimits>& limits,
                                     double most_cut, const VectorXd& units);

/// Of all joints, between the lines `before` and `after`. One place computes it: the ramp fits it to the last bit even
/// where the velocities are nearly equal.
VectorXd change_of_velocity(const Corner& corner, const VectorXd& before, const VectorXd& after);

/// Along the line between two corners, from the end of one ramp to the beginning of the next.
LineProfile profile_between(const Corner& corner, const Corner& next, const MotionLimits& line);

}  // namespace kinfer::motion
