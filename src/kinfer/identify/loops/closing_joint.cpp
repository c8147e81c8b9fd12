// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/loops/closing_joint.hpp"

#include <cmath>

#include "kinfer/base/angle.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer::identify {
namespace {

/// Axes a and b that maximise aᵀ M b: the largest singular pair, from the eigenvectors of Mᵀ M.
std::pair<Vec3, Vec3> dominant_pair(const Mat3& m) {
  const Vec3 b = symmetric_eigen(m.transpose() * m).vectors.col(2);
  return {(m * b).normalized(), b};
}

/// Points on both bodies, [p_first, p_second], nearest to the bodies' origins.
std::pair<Vec3, Vec3> common_points(std::span<const Pose> poses) {
  constexpr double prior_weight = 1e-6;  // per pose: keeps the point along the axis near the bodies' origins
  MatrixXd normal = MatrixXd::Zero(6, 6);
  VectorXd right = VectorXd::Zero(6);
  for (const Pose& pose : poses) {
    Eigen::Matrix<double, 3, 6> by_points;
    by_points << Mat3::Identity(), -pose.rotation;
    normal += by_points.transpose() * by_points;
    right += by_points.transpose() * pose.position;
  }
  normal.diagonal().array() += prior_weight * static_cast<double>(poses.size());
  const VectorXd points = solve_least_squares(normal, right);
  return {points.head<3>(), points.tail<3>()};
}

/// Rotation about the frames' z axes.
double angle_about(const Mat3& first_R_axis, const Mat3& rotation, const Mat3& second_R_axis) {
  const Mat3 turn = first_R_axis.transpose() * rotation * second_R_axis;
  return std::atan2(turn(1, 0) - turn(0, 1), turn(0, 0) + turn(1, 1));
}

}  // namespace

ClosingJoint fit_closing_joint(std::span<const Pose> first_T_second) {
  Mat3 sum = Mat3::Zero();
  for (const Pose& pose : first_T_second) sum += pose.rotation;
  const auto [axis, axis_in_second] = dominant_pair(sum);
  ClosingJoint closing;
  closing.joint = revolute_body(-1, -1, frame_with_z_along(axis), frame_with_z_along(axis_in_second));
  std::tie(closing.joint.point_in_parent, closing.joint.point_in_child) = common_points(first_T_second);
  const InsBody& joint = closing.joint;
  double gap = 0.0, misalignment = 0.0, sine = 0.0, cosine = 0.0;
  std::vector<double> angles;
  for (const Pose& pose : first_T_second) {
    const Vec3 between = pose * joint.point_in_child - joint.point_in_parent;
    gap += (between - axis * axis.dot(between)).squaredNorm();
    misalignment += axis.cross(pose.rotation * axis_in_second).squaredNorm();
    angles.push_back(angle_about(joint.parent_R_axis, pose.rotation, joint.child_R_axis));
    sine += std::sin(angles.back()), cosine += std::cos(angles.back());
  }
  const auto count = static_cast<double>(first_T_second.size());
  double square = 0.0;
  for (const double angle : angles) square += std::pow(wrap_to_pi(angle - std::atan2(sine, cosine)), 2);
  closing.gap = std::sqrt(gap / count);
  closing.misalignment = std::sqrt(misalignment / count);
  closing.rotation = std::sqrt(square / count);
  return closing;
}

}  // namespace kinfer::identify
