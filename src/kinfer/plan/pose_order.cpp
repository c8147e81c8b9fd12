// SPDX-License-Identifier: Apache-2.0
#include "kinfer/plan/pose_order.hpp"

#include <algorithm>

#include "kinfer/kinematics/poses/pose_constraints.hpp"
#include "kinfer/plan/thresholds.hpp"

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
  bool changed = true;
  for (int round = 0; changed && round < thresholds::two_opt_rounds; ++round) {
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
