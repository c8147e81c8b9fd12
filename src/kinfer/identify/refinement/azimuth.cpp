// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/refinement/azimuth.hpp"

#include <cmath>

#include "kinfer/identify/refinement/thresholds.hpp"

namespace kinfer::identify {
namespace {

using Index = Eigen::Index;

Vec3 perpendicular_part(const Vec3& v, const Vec3& axis) {
  return v - axis * axis.dot(v);
}

/// Standard deviation of the rotation of v about `axis`. `derivative`: of v by the unknowns from `first` on.
double rotation_sd(ConstMatrixRef covariance, Index first, const MatrixXd& derivative, const Vec3& v,
                   const Vec3& axis) {
  const double lever = perpendicular_part(v, axis).norm();
  const VectorXd by_unknowns = derivative.transpose() * axis.cross(v) / (lever * lever);
  const Index n = by_unknowns.size();
  return std::sqrt(std::max(0.0, by_unknowns.dot(covariance.block(first, first, n, n) * by_unknowns)));
}

}  // namespace

double azimuth_sd(const InsLayout& layout, const InsBodies& bodies, ConstMatrixRef covariance, std::size_t body) {
  const Vec3 axis = bodies[body].child_R_axis.col(2);
  double longest = min_azimuth_lever, sd = 0.0;
  for (std::size_t next = body + 1; next < bodies.size(); ++next) {
    const InsBody& joint = bodies[next];
    if (joint.parent != static_cast<int>(body) || !joint.free_parent_rotation[0]) continue;
    const Vec3 direction = joint.parent_R_axis.col(2), arm = joint.point_in_parent - bodies[body].point_in_child;
    MatrixXd by_rotations(3, 2);
    by_rotations << -joint.parent_R_axis.col(1), joint.parent_R_axis.col(0);
    const double lever = perpendicular_part(direction, axis).norm();
    if (lever > longest) {
      longest = lever;
      sd = rotation_sd(covariance, layout.body[next], by_rotations, direction, axis);
    } else if (longest <= min_azimuth_lever && perpendicular_part(arm, axis).norm() > min_azimuth_lever) {
      const Index point = layout.body[next] + joint.unknowns() - (joint.free_point_in_child ? 6 : 3);
      sd = rotation_sd(covariance, point, MatrixXd::Identity(3, 3), arm, axis);
    }
  }
  return sd;
}

}  // namespace kinfer::identify
