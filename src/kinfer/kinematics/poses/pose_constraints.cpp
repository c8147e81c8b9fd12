// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/poses/pose_constraints.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/kinematics/forward.hpp"

namespace kinfer {
JointRange joint_range(const Joint& joint) {
  const bool is_revolute = rotates(joint.type);
  const double low = std::isfinite(joint.lower) ? joint.lower : is_revolute ? -170.0 * degree : 0.0;
  const double high = std::isfinite(joint.upper) ? joint.upper : is_revolute ? 170.0 * degree : 0.3;
  constexpr double margin = 0.01;  // of the range: a pose at a limit may not be reached by the real robot
  return {low + margin * (high - low), high - margin * (high - low)};
}

bool satisfies_constraints(const Chain& chain, ConstVectorRef q, const PoseConstraints& space) {
  const Pose world_T_tool = forward(chain, q), base_T_world = chain.base.pose().inverse();
  const Vec3 tool = base_T_world * world_T_tool.position;
  if (tool.z() < space.lowest || tool.head<2>().norm() < space.clearance) return false;
  if (std::isfinite(space.lowest))
    for (const Pose& frame : joint_frames(chain, q))
      if ((base_T_world * frame.position).z() < space.lowest) return false;
  if (!space.instrument) return true;
  const Vec3 towards = *space.instrument - world_T_tool.position;
  return angle_between(Vec3(world_T_tool.rotation * space.target_direction), towards) <= space.acceptance_angle;
}

VectorXd draw_pose_near(const Chain& chain, const PoseConstraints& space, ConstVectorRef q, Rng& rng) {
  const std::vector<int> moving = active_joints(chain);
  constexpr int tries = 4;
  for (int i = 0; i < tries; ++i) {
    const double step = std::pow(10.0, rng.uniform(-2.0, 0.0));  // of the ranges
    VectorXd next = q;
    for (Eigen::Index k = 0; k < q.size(); ++k) {
      const JointRange range = joint_range(chain.joints[moving[k]]);
      if (rng.uniform() < 0.5)
        next[k] = std::clamp(q[k] + step * (range.high - range.low) * rng.normal(), range.low, range.high);
    }
    if (satisfies_constraints(chain, next, space)) return next;
  }
  return {};
}

Result<MatrixXd> draw_poses(const Chain& chain, const PoseConstraints& space, int count, Rng rng) {
  const std::vector<int> moving = active_joints(chain);
  MatrixXd poses(static_cast<Eigen::Index>(moving.size()), count);
  for (int i = 0; i < count; ++i) {
    Rng draws = rng.stream(i);
    constexpr int patience = 5000;
    int tries = 0;
    do {
      if (++tries > patience)
        return error("none of {} random poses satisfies the joint limits, floor, clearance and visibility", patience);
      for (std::size_t k = 0; k < moving.size(); ++k) {
        const JointRange range = joint_range(chain.joints[moving[k]]);
        poses(static_cast<Eigen::Index>(k), i) = draws.uniform(range.low, range.high);
      }
    } while (!satisfies_constraints(chain, poses.col(i), space));
  }
  return poses;
}

}  // namespace kinfer
