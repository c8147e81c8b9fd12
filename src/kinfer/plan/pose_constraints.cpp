// SPDX-License-Identifier: Apache-2.0
#include "kinfer/plan/pose_constraints.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/angle.hpp"
#include "kinfer/kinematics/forward.hpp"

namespace kinfer::plan {
namespace {

double joint_distance(const MatrixXd& q, int a, int b) {
  return (q.col(a) - q.col(b)).cwiseAbs().maxCoeff();
}

std::vector<int> nearest_neighbours(const MatrixXd& q, int first) {
  std::vector<int> order{first}, left;
  for (int i = 0; i < q.cols(); ++i)
    if (i != first) left.push_back(i);
  while (!left.empty()) {
    const auto next = std::min_element(left.begin(), left.end(), [&](int a, int b) {
      return joint_distance(q, order.back(), a) < joint_distance(q, order.back(), b);
    });
    order.push_back(*next);
    left.erase(next);
  }
  return order;
}

/// Reverses subsequences as long as that shortens the travel; the first pose is fixed.
void two_opt(const MatrixXd& q, std::vector<int>& order) {
  const std::size_t n = order.size();
  constexpr int most_rounds = 50;
  bool changed = true;
  for (int round = 0; changed && round < most_rounds; ++round) {
    changed = false;
    for (std::size_t i = 1; i + 1 < n; ++i)
      for (std::size_t j = i + 1; j < n; ++j) {
        const double after_j =
            j + 1 < n ? joint_distance(q, order[i], order[j + 1]) - joint_distance(q, order[j], order[j + 1]) : 0.0;
        if (joint_distance(q, order[i - 1], order[j]) - joint_distance(q, order[i - 1], order[i]) + after_j >= -1e-12)
          continue;
        std::reverse(order.begin() + static_cast<std::ptrdiff_t>(i),
                     order.begin() + static_cast<std::ptrdiff_t>(j) + 1);
        changed = true;
      }
  }
}

}  // namespace

JointRange joint_range(const Joint& joint) {
  const bool is_revolute = joint.type == JointType::revolute;
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

std::vector<int> order_by_travel(const Chain& chain, const MatrixXd& q) {
  if (q.cols() == 0) return {};
  VectorXd middle(q.rows());
  const std::vector<int> moving = active_joints(chain);
  for (Eigen::Index k = 0; k < q.rows(); ++k) {
    const JointRange range = joint_range(chain.joints[moving[k]]);
    middle[k] = 0.5 * (range.low + range.high);
  }
  Eigen::Index first = 0;
  (q.colwise() - middle).cwiseAbs().colwise().maxCoeff().minCoeff(&first);
  std::vector<int> order = nearest_neighbours(q, static_cast<int>(first));
  two_opt(q, order);
  return order;
}

double travel(const MatrixXd& q, const std::vector<int>& order) {
  double sum = 0.0;
  for (std::size_t i = 1; i < order.size(); ++i) sum += joint_distance(q, order[i - 1], order[i]);
  return sum;
}

}  // namespace kinfer::plan
