// SPDX-License-Identifier: Apache-2.0
// Feasible poses: joint limits, floor, clearance, and visibility from the instrument.
#pragma once

#include <limits>
#include <optional>

#include "kinfer/base/angle.hpp"
#include "kinfer/base/result.hpp"
#include "kinfer/base/rng.hpp"
#include "kinfer/kinematics/chain.hpp"
#include "kinfer/linalg/types.hpp"

namespace kinfer {

struct PoseConstraints {
  double lowest = -std::numeric_limits<double>::infinity();  ///< [m] minimum height of tool and joints over the base
  double clearance = 0.0;                   ///< [m] minimum distance of the tool from the base's z axis
  std::optional<Vec3> instrument{};         ///< [m] in the world
  Vec3 target_direction = Vec3::UnitZ();    ///< viewing direction of the target, in the tool frame
  double acceptance_angle = 60.0 * degree;  ///< [rad] half angle within which the target is seen
};

/// Smallest and largest position of a joint to be planned: its limits, else ±170° or 0 .. 0.3 m, less a hundredth at
/// each end.
struct JointRange {
  double low = 0.0, high = 0.0;
};
JointRange joint_range(const Joint& joint);

/// Whether floor, clearance and visibility allow the pose; joint limits are not checked.
bool satisfies_constraints(const Chain& chain, ConstVectorRef q, const PoseConstraints& space);

/// A feasible pose near `q`: a random subset of joints moved a little or far, within their ranges; empty if several
/// tries fail.
VectorXd draw_pose_near(const Chain& chain, const PoseConstraints& space, ConstVectorRef q, Rng& rng);

/// `count` feasible poses drawn uniformly from the joint ranges, dof x count. An error if hardly any pose is feasible.
Result<MatrixXd> draw_poses(const Chain& chain, const PoseConstraints& space, int count, Rng rng);

}  // namespace kinfer
