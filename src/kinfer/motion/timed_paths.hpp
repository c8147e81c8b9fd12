// SPDX-License-Identifier: Apache-2.0
// Paths ready for a controller: sampled in time, checked against joint limits and singular postures.
#pragma once

#include "kinfer/base/result.hpp"
#include "kinfer/evidence/motion/timed_path.hpp"
#include "kinfer/motion/joint_path.hpp"
#include "kinfer/motion/reach.hpp"

namespace kinfer::motion {

/// Through the postures `waypoints` (dof x n), straight in joint space; a sample every `step` [s] and one at the end.
/// Refused where the samples would be more than thresholds::most_samples.
Result<PathResult> joint_space_path(const Chain& chain, const MatrixXd& waypoints,
                                    const std::vector<MotionLimits>& limits, const JointPathOptions& options,
                                    double step);

struct ToolPathOptions {
  MotionLimits translation{0.25, 1.0, 5.0};  ///< of the tool point [m/s], [m/s²], [m/s³]
  MotionLimits rotation{1.0, 4.0, 20.0};     ///< of its orientation [rad/s], …
  ReachOptions reach{};
  int threads = 1;  ///< for the targets one by one, after an obstacle
};

/// Through targets on straight lines of the tool point, orientations turning about one axis a line; at rest at each
/// target. All targets must direct the orientation in the same way (OrientationGoal). Where a joint would exceed its
/// limits of velocity, acceleration or jerk, the whole path is slowed down (TimedPath::slowed_by). Refused above
/// thresholds::most_tool_samples.
Result<PathResult> tool_space_path(const Chain& chain, const std::vector<ReachTarget>& targets,
                                   const VectorXd& preferred, const std::vector<MotionLimits>& limits,
                                   const ToolPathOptions& options, double step);

/// Between two targets of the same kind of orientation, at the part `s` of the way.
ReachTarget interpolate(const ReachTarget& from, const ReachTarget& to, double s);

}  // namespace kinfer::motion
