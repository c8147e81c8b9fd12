#include "kinfer/identify/azimuth.hpp"

#include <cmath>

namespace kinfer {
namespace {

using Index = Eigen::Index;

Vec3 across(const Vec3& v, const Vec3& axis) {
  return v - axis * axis.dot(v);
}

/// Sd of the turn about `axis` that `moved` shows: v moves by `moved`'s linear map of unknowns from `first` on.
double turn_sd(ConstMatrixRef covariance, Index first, const MatrixXd& moved, const Vec3& v, const Vec3& axis) {
  const double lever = across(v, axis).norm();
  const VectorXd by_unknowns = moved.transpose() * axis.cross(v) / (lever * lever);
  const Index n = by_unknowns.size();
  return std::sqrt(std::max(0.0, by_unknowns.dot(covariance.block(first, first, n, n) * by_unknowns)));
}

}  // namespace

double azimuth_sd(const InsLayout& layout, const InsBodies& bodies, ConstMatrixRef covariance, std::size_t body) {
  constexpr double least_lever = 0.1;  // [m], or sine of the angle between axes
  const Vec3 axis = bodies[body].child_R_axis.col(2);
  double farthest = least_lever, sd = 0.0;
  for (std::size_t next = body + 1; next < bodies.size(); ++next) {
    const InsBody& joint = bodies[next];
    if (joint.parent != static_cast<int>(body) || !joint.free_parent_turn[0]) continue;
    const Vec3 direction = joint.parent_R_axis.col(2), arm = joint.point_in_parent - bodies[body].point_in_child;
    MatrixXd by_turns(3, 2);
    by_turns << -joint.parent_R_axis.col(1), joint.parent_R_axis.col(0);
    const double lever = across(direction, axis).norm();
    if (lever > farthest) {
      farthest = lever;
      sd = turn_sd(covariance, layout.body[next], by_turns, direction, axis);
    } else if (farthest <= least_lever && across(arm, axis).norm() > least_lever) {
      const Index point = layout.body[next] + joint.unknowns() - (joint.free_point_in_child ? 6 : 3);
      sd = turn_sd(covariance, point, MatrixXd::Identity(3, 3), arm, axis);
    }
  }
  return sd;
}

}  // namespace kinfer
