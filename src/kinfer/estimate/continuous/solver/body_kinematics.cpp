// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/solver/body_kinematics.hpp"

#include <algorithm>

namespace kinfer {
namespace {

using Index = Eigen::Index;

double spline_dimension_value(const MatrixXd& coefficients, Index spline_dimension, Index interval,
                              const SplineBasis& basis) {
  double sum = 0.0;
  for (Index i = 0; i < spline_order; ++i)
    sum += basis.at[0][static_cast<std::size_t>(i)] * coefficients(spline_dimension, interval + i);
  return sum;
}

Mat3 joint_rotation(JointMotion motion, const Vec3& position) {
  if (motion == JointMotion::revolute) return rot_z(position.x());
  if (motion == JointMotion::spherical) return exp_so3(position);
  return Mat3::Identity();
}

/// Rotation axes of the joint's degrees of freedom in the joint's frame, a column each.
Mat3 rotation_axes(JointMotion motion, const Vec3& position) {
  Mat3 axes = Mat3::Zero();
  if (motion == JointMotion::revolute) axes.col(0) = Vec3::UnitZ();
  if (motion == JointMotion::spherical) axes = right_jacobian(-position);  // the left Jacobian
  return axes;
}

}  // namespace

MachineSnapshot machine_snapshot(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x,
                                 double time) {
  const auto [interval, place] = problem.grid.locate(time);
  MachineSnapshot s{interval, spline_basis(place, problem.grid.period), {BodyKinematics{}}};
  for (std::size_t b = 1; b < x.bodies.size(); ++b) {
    const InsBody& body = x.bodies[b];
    const BodyKinematics& parent = s.body[static_cast<std::size_t>(body.parent)];
    Vec3 vector = Vec3::Zero();
    for (Index i = 0; i < degrees_of_freedom(body.motion); ++i)
      vector[i] = spline_dimension_value(x.spline_coefficients, layout.spline_dimension[b] + i, interval, s.basis);
    const double q = vector.x();
    BodyKinematics placed{.parent = parent.rotation, .before = parent.rotation * body.parent_R_axis};
    placed.after = placed.before * joint_rotation(body.motion, vector);
    placed.rotation_axes = placed.before * rotation_axes(body.motion, vector);
    placed.rotation = placed.after * body.child_R_axis.transpose();
    placed.pivot = parent.origin + parent.rotation * body.point_in_parent;
    placed.joint = placed.pivot + (body.motion == JointMotion::prismatic ? q : 0.0) * placed.before.col(2);
    placed.origin = placed.joint - placed.rotation * body.point_in_child;
    s.body.push_back(placed);
  }
  return s;
}

namespace {

class PointMover {
 public:
  PointMover(const InsLayout& layout, const InsUnknowns& x, const MachineSnapshot& s, PointJacobian& point)
      : layout_(layout), x_(x), s_(s), p_(point) {
    p_.by_position = p_.by_rotation = Rows3::Zero(3, first_global(layout) + layout.global_parameters);
  }

  void move_with_ancestors(int b) {
    for (; b > 0; b = x_.bodies[static_cast<std::size_t>(b)].parent) {
      by_child_side(static_cast<std::size_t>(b));
      by_parent_side(static_cast<std::size_t>(b));
    }
  }

  /// Derivatives with respect to A and the point p.
  void by_parent_side(std::size_t b) {
    const InsBody& body = x_.bodies[b];
    const BodyKinematics& placed = s_.body[b];
    Index at = first_global(layout_) + layout_.body[b];
    for (int i = 0; i < 3; ++i)
      if (body.free_parent_rotation[static_cast<std::size_t>(i)]) turn(at++, 1.0, placed.before.col(i), placed.pivot);
    at = first_global(layout_) + layout_.body[b] + std::ranges::count(body.free_parent_rotation, true) +
         std::ranges::count(body.free_child_rotation, true);
    if (body.free_point_in_parent) p_.by_position.middleCols<3>(at) += placed.parent;
  }

 private:
  void turn(Index column, double factor, const Vec3& axis, const Vec3& about) {
    p_.by_position.col(column) += factor * axis.cross(p_.position - about);
    p_.by_rotation.col(column) += factor * axis;
  }

  /// Derivatives with respect to B, the point c and the joint position.
  void by_child_side(std::size_t b) {
    const InsBody& body = x_.bodies[b];
    const BodyKinematics& placed = s_.body[b];
    Index at = first_global(layout_) + layout_.body[b] + std::ranges::count(body.free_parent_rotation, true);
    for (int i = 0; i < 3; ++i)
      if (body.free_child_rotation[static_cast<std::size_t>(i)]) turn(at++, -1.0, placed.after.col(i), placed.joint);
    at += body.free_point_in_parent ? 3 : 0;
    if (body.free_point_in_child) p_.by_position.middleCols<3>(at) -= placed.rotation;
    if (layout_.spline_dimension[b] < 0) return;
    for (Index i = 0; i < spline_order; ++i)
      for (Index k = 0; k < degrees_of_freedom(body.motion); ++k) {
        const Index column = i * layout_.spline_dimensions + layout_.spline_dimension[b] + k;
        const double weight = s_.basis.at[0][static_cast<std::size_t>(i)];
        if (body.motion == JointMotion::prismatic)
          p_.by_position.col(column) += weight * placed.before.col(2);
        else
          turn(column, weight, placed.rotation_axes.col(k), placed.joint);
      }
  }

  const InsLayout& layout_;
  const InsUnknowns& x_;
  const MachineSnapshot& s_;
  PointJacobian& p_;
};

}  // namespace

PointJacobian jacobian_at(const InsLayout& layout, const InsUnknowns& x, const MachineSnapshot& s, std::size_t body,
                          const Vec3& local) {
  PointJacobian point{.position = s.body[body].pose() * local, .by_position = {}, .by_rotation = {}};
  PointMover(layout, x, s, point).move_with_ancestors(static_cast<int>(body));
  return point;
}

PointJacobian jacobian_at_joint(const InsLayout& layout, const InsUnknowns& x, const MachineSnapshot& s,
                                std::size_t body) {
  PointJacobian point{.position = s.body[body].pivot, .by_position = {}, .by_rotation = {}};
  PointMover mover(layout, x, s, point);
  mover.by_parent_side(body);
  mover.move_with_ancestors(x.bodies[body].parent);
  return point;
}

}  // namespace kinfer
