// SPDX-License-Identifier: Apache-2.0
// Paths through postures: straight lines in joint space, joined at corners, all joints in step.
//
// On each line the joints move in proportion, by the double S between the speeds at its ends. At a corner the
// velocities of all joints change together from those along one line to those along the next by one S ramp, centred on
// the waypoint: speed, acceleration and jerk of every joint stay within their limits, and the corner is cut by a known
// amount. Only near a corner is the path slowed down for it; where a stop is quicker, it stops there.
#pragma once

#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/linalg/types.hpp"
#include "kinfer/motion/s_ramp.hpp"

namespace kinfer::motion {

/// All joints at one time.
struct PathState {
  VectorXd position, velocity, acceleration, jerk;  ///< [rad] or [m], per s, s², s³
};

struct JointPathOptions {
  bool stop_at_waypoints = false;
  double most_cut = 0.05;  ///< units of any joint that a corner may be cut by; larger: quicker; 0: stops
  VectorXd cut_units{};    ///< of each joint [rad] or [m]; empty: 1
};

class JointPath {
 public:
  /// `waypoints`: dof x n, the path begins and ends at rest; equal neighbours count once. `limits`: of each joint.
  JointPath(const MatrixXd& waypoints, const std::vector<MotionLimits>& limits, const JointPathOptions& options = {});

  double duration() const { return duration_; }  ///< [s]; 0 where the path does not move
  PathState at(double t) const;                  ///< [s], clamped to the duration
  /// [s] when the path is at, or cuts, each waypoint.
  const std::vector<double>& passing_times() const { return passing_times_; }
  /// Units by which each corner is cut, in the joint that misses its waypoint most; 0 below 1e-9.
  const std::vector<double>& cuts() const { return cuts_; }

 private:
  /// From rest to rest through waypoints of which neighbours differ.
  void append(const MatrixXd& waypoints, const std::vector<MotionLimits>& limits, double most_cut,
              const VectorXd& units);

  /// A change of velocity. The joints move at `after` until the next one begins.
  struct Ramp {
    double begin = 0.0;                    ///< [s]
    VectorXd from{};                       ///< positions where it begins
    VectorXd before{}, change{}, after{};  // velocities; the change by itself, as it may be tiny
    SRamp shape{};
  };
  std::vector<Ramp> ramps_;
  std::vector<double> cuts_, passing_times_;
  VectorXd end_;
  double duration_ = 0.0;
};

}  // namespace kinfer::motion
