// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/joint_scales.hpp"

#include <algorithm>

#include "kinfer/kinematics/forward.hpp"

namespace kinfer {
namespace {

constexpr double least_angle = 1e-3;    // [rad]: smaller ranges are scatter; of the worst encoders 1e-4
constexpr double least_beside = 0.1;    // [rad] beside joints that translate
constexpr double least_part = 0.1;      // of the tool's range, beside joints that rotate
constexpr Eigen::Index postures = 200;  // whose tool is looked at, at most about

/// Largest range of a coordinate of the tool [m].
double tool_range(const Chain& chain, ConstMatrixRef joints) {
  const PoseEvaluator evaluator(chain, {});
  Vec3 least = evaluator.pose(joints.col(0)).position, most = least;
  for (Eigen::Index k = 0; k < joints.cols(); k += std::max<Eigen::Index>(1, joints.cols() / postures)) {
    const Vec3 position = evaluator.pose(joints.col(k)).position;
    least = least.cwiseMin(position), most = most.cwiseMax(position);
  }
  return (most - least).maxCoeff();
}

}  // namespace

VectorXd joint_scales(const Chain& chain, ConstMatrixRef joints) {
  VectorXd scale = VectorXd::Zero(joints.rows());
  if (joints.cols() == 0) return scale;
  const VectorXd range = joints.rowwise().maxCoeff() - joints.rowwise().minCoeff();
  double turn = 0.0, shift = 0.0;
  const std::vector<int> moving = active_joints(chain);
  const auto kind_of_joint = [&](Eigen::Index k) -> double& {
    return translates(chain.joints[static_cast<std::size_t>(moving[static_cast<std::size_t>(k)])].type) ? shift : turn;
  };
  for (Eigen::Index k = 0; k < range.size(); ++k) kind_of_joint(k) = std::max(kind_of_joint(k), range[k]);
  if (turn > 0.0) turn = std::max(turn, least_angle);
  if (turn > 0.0 && shift > 0.0) {
    turn = std::max(turn, least_beside);
    shift = std::max(shift, least_part * tool_range(chain, joints));
  }
  for (Eigen::Index k = 0; k < range.size(); ++k) scale[k] = kind_of_joint(k);
  return scale;
}

}  // namespace kinfer
