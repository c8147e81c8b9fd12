// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/geometry/joint_geometry.hpp"

#include <cmath>
#include <optional>

#include "kinfer/base/angle.hpp"
#include "kinfer/base/expect.hpp"
#include "kinfer/identify/geometry/thresholds.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer::identify {
namespace {

constexpr double zero_tolerance = 1e-9;  // [rad] or [m]; below it, a parameter counts as 0

/// Unit vectors that all rotations map onto each other, R b = a: the smallest singular direction of [R, -1].
void fit_axis_directions(JointGeometry& revolute, const std::vector<Pose>& poses) {
  MatrixXd system(3 * static_cast<Eigen::Index>(poses.size()), 6);
  for (std::size_t i = 0; i < poses.size(); ++i)
    system.middleRows<3>(3 * static_cast<Eigen::Index>(i)) << poses[i].rotation, -Mat3::Identity();
  const VectorXd direction = right_svd(system).v.col(5);
  revolute.axis_in_child = direction.head<3>().normalized();
  revolute.axis_in_parent = direction.tail<3>().normalized();
}

/// Points that all poses map onto each other, R c + t = p; then the ones on the axis nearest to the child's origin.
void fit_axis_points(JointGeometry& revolute, const std::vector<Pose>& poses) {
  MatrixXd system(3 * static_cast<Eigen::Index>(poses.size()), 6);
  VectorXd right(system.rows());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    system.middleRows<3>(3 * static_cast<Eigen::Index>(i)) << poses[i].rotation, -Mat3::Identity();
    right.segment<3>(3 * static_cast<Eigen::Index>(i)) = -poses[i].position;
  }
  const VectorXd points = solve_least_squares(system, right, 1e-6);  // the undetermined shift along the axis is 0
  const double along = revolute.axis_in_child.dot(points.head<3>());
  revolute.point_in_child = points.head<3>() - along * revolute.axis_in_child;
  revolute.point_in_parent = points.tail<3>() - along * revolute.axis_in_parent;
}

/// Orients the axis so that the joint angle increases with the signals.
void orient_axes(JointGeometry& revolute, const std::vector<Pose>& poses, const std::vector<SignalRow>& signals) {
  double product = 0.0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    double sum = 0.0;
    for (const double angle : signals[i].angle) sum += angle;
    product += sum * revolute.axis_in_parent.dot(log_so3(poses[i].rotation * revolute.home.rotation.transpose()));
  }
  if (product >= 0.0) return;
  revolute.axis_in_parent = -revolute.axis_in_parent;
  revolute.axis_in_child = -revolute.axis_in_child;
}

bool is_zero(double number) {
  return std::abs(number) < zero_tolerance;
}
bool has_theta(const DhLeaf& leaf) {
  return leaf.theta_signal != DhLeaf::constant || !is_zero(leaf.theta);
}
bool has_alpha(const DhLeaf& leaf) {
  return leaf.alpha_signal != DhLeaf::constant || !is_zero(leaf.alpha);
}

/// Adds two angles; false if both are signals, or if one is a signal without an offset and the other a constant: the
/// paper's leaves cannot hold both.
bool try_add_angle(double& value, int& signal, double other, int other_signal) {
  const bool is_signal = signal != DhLeaf::constant, other_is_signal = other_signal != DhLeaf::constant;
  if ((is_signal && other_is_signal) || (is_signal && is_zero(value) && !is_zero(other)) ||
      (other_is_signal && is_zero(other) && !is_zero(value)))
    return false;
  value += other;
  if (other_signal != DhLeaf::constant) signal = other_signal;
  return true;
}

/// Merges two leaves into one where that is exact. Within a leaf the order is d, theta, a, alpha; d and theta commute,
/// so do a and alpha.
std::optional<DhLeaf> merge_pair(const DhLeaf& first, const DhLeaf& second) {
  DhLeaf leaf = first;
  if (!has_alpha(first) && is_zero(first.a)) {  // z is unchanged: d and theta of both add up
    leaf.d += second.d;
    leaf.a = second.a;
    leaf.alpha = second.alpha;
    leaf.alpha_signal = second.alpha_signal;
    if (try_add_angle(leaf.theta, leaf.theta_signal, second.theta, second.theta_signal)) return leaf;
  }
  leaf = first;
  if (!has_theta(second) && is_zero(second.d)) {  // x is unchanged: a and alpha of both add up
    leaf.a += second.a;
    if (try_add_angle(leaf.alpha, leaf.alpha_signal, second.alpha, second.alpha_signal)) return leaf;
  }
  if (!has_alpha(first) && !has_theta(second)) {  // d of the second is along the same z
    leaf = first;
    leaf.d += second.d;
    leaf.a += second.a;
    leaf.alpha = second.alpha;
    leaf.alpha_signal = second.alpha_signal;
    return leaf;
  }
  return std::nullopt;
}

}  // namespace

JointGeometry fit_revolute_geometry(std::span<const DhLeaf> leaves, const std::vector<SignalRow>& signals) {
  KINFER_EXPECT(signals.size() >= 3);
  std::vector<Pose> poses;
  for (const SignalRow& row : signals) poses.push_back(transform(leaves, row.angle));
  JointGeometry revolute;
  revolute.home = transform(leaves, std::vector<double>(signals.front().angle.size(), 0.0));
  fit_axis_directions(revolute, poses);
  fit_axis_points(revolute, poses);
  orient_axes(revolute, poses, signals);
  return revolute;
}

Pose pose_at(const JointGeometry& revolute, double angle) {
  const Mat3 turn = exp_so3(angle * revolute.axis_in_parent);
  return {turn * revolute.home.rotation,
          revolute.point_in_parent + turn * (revolute.home.position - revolute.point_in_parent)};
}

Pose transform(const DhNumbers& row) {
  return Pose{rot_z(row.theta), {0.0, 0.0, row.d}} * Pose{rot_x(row.alpha) * rot_y(row.beta), {row.a, 0.0, 0.0}};
}

DhNumbers dh_row_to_line(const Vec3& point, const Vec3& direction) {
  const double sine = std::hypot(direction.x(), direction.y());
  DhNumbers row;
  if (sine < max_hayati_sine) {  // x towards where the line meets the plane d = 0; then two small rotations
    const Vec3 meets = point - (point.z() / direction.z()) * direction;
    row.a = std::hypot(meets.x(), meets.y());
    row.theta = row.a > zero_tolerance ? std::atan2(meets.y(), meets.x()) : 0.0;
    const Vec3 rotated = rot_z(-row.theta) * direction;  // = RotX(alpha) RotY(beta) z
    row.beta = std::asin(rotated.x());
    row.alpha = std::atan2(-rotated.y(), rotated.z());
    return row;
  }
  // x is the common normal z × direction, so that a rotation by alpha about it takes z to the direction.
  row.theta = std::atan2(direction.x(), -direction.y());
  row.alpha = std::atan2(sine, direction.z());
  const Vec3 x(std::cos(row.theta), std::sin(row.theta), 0.0), across(-x.y(), x.x(), 0.0);
  row.a = point.dot(x);
  row.d = point.z() - direction.z() * point.dot(across) / direction.dot(across);
  return row;
}

std::vector<DhNumbers> dh_rows_through(const Vec3& point, std::span<const Vec3> axes, const Pose& home) {
  std::vector<DhNumbers> rows;
  Pose parent_T_here;
  const auto add = [&](const Vec3& on_line, const Vec3& direction) {
    const Pose here = parent_T_here.inverse();
    rows.push_back(dh_row_to_line(here * on_line, here.rotation * direction));
    parent_T_here = parent_T_here * transform(rows.back());
  };
  for (const Vec3& axis : axes) add(point, axis);
  add(home.position, home.rotation.col(2));
  const Pose rest = parent_T_here.inverse() * home;  // translation along and rotation about z only
  rows.push_back({.d = rest.position.z(), .theta = std::atan2(rest.rotation(1, 0), rest.rotation(0, 0))});
  return rows;
}

std::array<DhNumbers, 3> canonical_dh_rows(const JointGeometry& revolute) {
  const auto rows = dh_rows_through(revolute.point_in_parent, std::span(&revolute.axis_in_parent, 1), revolute.home);
  return {rows[0], rows[1], rows[2]};
}

std::vector<DhLeaf> merge_leaves(std::vector<DhLeaf> leaves) {
  for (std::size_t i = 0; i + 1 < leaves.size();) {
    if (const auto pair = merge_pair(leaves[i], leaves[i + 1])) {
      leaves[i] = *pair;
      leaves.erase(leaves.begin() + static_cast<std::ptrdiff_t>(i) + 1);
      i = i > 0 ? i - 1 : 0;
    } else {
      ++i;
    }
  }
  const auto wrap = [](double& angle) { angle = wrap_to_pi(angle); };
  for (DhLeaf& leaf : leaves) wrap(leaf.theta), wrap(leaf.alpha);
  return leaves;
}

}  // namespace kinfer::identify
