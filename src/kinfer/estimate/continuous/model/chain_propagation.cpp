// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/model/chain_propagation.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/expect.hpp"
#include "kinfer/geometry/rotation_vector_motion.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;

/// K with f(r) = f(0) + K r: skew(ω̇) + skew(ω)².
Mat3 lever_matrix(const Vec3& angular_velocity, const Vec3& angular_acceleration) {
  const Mat3 w = skew(angular_velocity);
  return skew(angular_acceleration) + w * w;
}

/// Propagation through a joint at one time: the terms shared by value and Jacobian.
struct JointPropagation {
  Mat3 turn;               // child_R_parent
  Vec3 axis_parent, axis;  // in the parent, in the child
  Vec3 relative_velocity,
      relative_acceleration;  // angular velocity and acceleration of the child relative to the parent, in the child
  Vec3 arm, arm_velocity, arm_acceleration;  // d and its derivatives, in the parent
  Vec3 rate_in_child;                        // R ω
  Vec3 force_at_joint;                       // R f_J
  InsState child;
};

Mat3 inverse_joint_rotation(const InsBody& body, const Vec3& q) {
  if (body.motion == JointMotion::revolute) return rot_z(-q.x());
  if (body.motion == JointMotion::spherical) return exp_so3(-q);
  return Mat3::Identity();
}

void relative_velocity(JointPropagation& p, const InsBody& body, const JointKinematicState& q) {
  p.relative_velocity = p.relative_acceleration = Vec3::Zero();
  if (body.motion == JointMotion::revolute) {
    p.relative_velocity = q[1].x() * p.axis;
    p.relative_acceleration = q[2].x() * p.axis;
  } else if (body.motion == JointMotion::spherical) {
    const RotationVectorMotion r = rotation_vector_motion(q[0], q[1], q[2]);
    p.relative_velocity = body.child_R_axis * r.angular_velocity;
    p.relative_acceleration = body.child_R_axis * r.angular_acceleration;
  }
}

JointPropagation propagate_through_joint(const InsBody& body, const JointKinematicState& q, const InsState& parent) {
  JointPropagation p;
  const double is_prismatic = body.motion == JointMotion::prismatic ? 1.0 : 0.0;
  p.axis_parent = body.parent_R_axis.col(2);
  p.axis = body.child_R_axis.col(2);
  p.turn = body.child_R_axis * inverse_joint_rotation(body, q[0]) * body.parent_R_axis.transpose();
  relative_velocity(p, body, q);
  p.arm = body.point_in_parent + is_prismatic * q[0].x() * p.axis_parent;
  p.arm_velocity = is_prismatic * q[1].x() * p.axis_parent;
  p.arm_acceleration = is_prismatic * q[2].x() * p.axis_parent;
  const Vec3 at_joint = parent.force + parent.angular_acceleration.cross(p.arm) +
                        parent.angular_velocity.cross(parent.angular_velocity.cross(p.arm)) +
                        2.0 * parent.angular_velocity.cross(p.arm_velocity) + p.arm_acceleration;
  p.force_at_joint = p.turn * at_joint;
  p.rate_in_child = p.turn * parent.angular_velocity;
  p.child.angular_velocity = p.rate_in_child + p.relative_velocity;
  p.child.angular_acceleration =
      p.turn * parent.angular_acceleration + p.relative_acceleration - p.relative_velocity.cross(p.rate_in_child);
  const Vec3& c = body.point_in_child;
  p.child.force = p.force_at_joint - p.child.angular_acceleration.cross(c) -
                  p.child.angular_velocity.cross(p.child.angular_velocity.cross(c));
  return p;
}

/// Writes one Jacobian column from the derivatives of angular velocity, angular acceleration and specific force at the
/// joint (in the child).
struct JacobianColumnWriter {
  const JointPropagation& p;
  const Vec3& c;
  Mat3 by_rate;  // of f_c by ω_c

  void put(StateJacobian& columns, Index column, const Vec3& angular_velocity, const Vec3& angular_acceleration,
           const Vec3& force_at_joint) const {
    columns.col(column) << angular_velocity, angular_acceleration,
        force_at_joint - angular_acceleration.cross(c) + by_rate * angular_velocity;
  }
};

Mat3 lever_by_angular_velocity(const Vec3& angular_velocity, const Vec3& arm) {  // −d(ω × (ω × r))/dω
  return skew(angular_velocity.cross(arm)) + skew(angular_velocity) * skew(arm);
}

void by_parent_state(const JointPropagation& p, const InsState& parent, const JacobianColumnWriter& maker,
                     Eigen::Matrix<double, state_size, state_size>& by_parent) {
  const Mat3& r = p.turn;
  by_parent.setZero();
  by_parent.block<3, 3>(0, 0) = r;
  by_parent.block<3, 3>(3, 0) = -skew(p.relative_velocity) * r;
  by_parent.block<3, 3>(3, 3) = r;
  const Mat3 joint_by_rate = -lever_by_angular_velocity(parent.angular_velocity, p.arm) - 2.0 * skew(p.arm_velocity);
  const Mat3 arm = skew(maker.c);
  by_parent.block<3, 3>(6, 0) = r * joint_by_rate + arm * by_parent.block<3, 3>(3, 0) + maker.by_rate * r;
  by_parent.block<3, 3>(6, 3) = -r * skew(p.arm) + arm * r;
  by_parent.block<3, 3>(6, 6) = r;
}

/// Column of a small rotation of the joint about m (in the child): the parent's frame rotates by −m as seen from the
/// child.
void put_rotation(StateJacobian& columns, Index column, const JointPropagation& p, const InsState& parent,
                  const JacobianColumnWriter& maker, const Vec3& m, const Vec3& joint_force_change) {
  const Vec3 angular_velocity = -m.cross(p.rate_in_child);
  const Vec3 angular_acceleration =
      -m.cross(p.turn * parent.angular_acceleration) - p.relative_velocity.cross(angular_velocity);
  maker.put(columns, column, angular_velocity, angular_acceleration, -m.cross(p.force_at_joint) + joint_force_change);
}

/// Column of a change of the relative angular velocity and acceleration.
void put_relative_velocity(StateJacobian& columns, Index column, const JointPropagation& p,
                           const JacobianColumnWriter& maker, const Vec3& change, const Vec3& change_of_change) {
  maker.put(columns, column, change, change_of_change - change.cross(p.rate_in_child), Vec3::Zero());
}

void by_spherical_joint(StateJacobian& columns, const InsBody& body, const JointKinematicState& q,
                        const JointPropagation& p, const InsState& parent, const JacobianColumnWriter& maker) {
  const RotationVectorMotion r = rotation_vector_motion(q[0], q[1], q[2]);
  const Mat3& b = body.child_R_axis;
  for (Index i = 0; i < 3; ++i) {
    const Vec3 turn = b * r.jacobian.col(i);
    put_relative_velocity(columns, 3 * i, p, maker, b * r.velocity_by_vector.col(i),
                          b * r.acceleration_by_vector.col(i));
    const Eigen::Matrix<double, state_size, 1> of_spin = columns.col(3 * i);
    put_rotation(columns, 3 * i, p, parent, maker, turn, Vec3::Zero());
    columns.col(3 * i) += of_spin;
    put_relative_velocity(columns, 3 * i + 1, p, maker, turn, b * r.acceleration_by_velocity.col(i));
    put_relative_velocity(columns, 3 * i + 2, p, maker, Vec3::Zero(), turn);
  }
}

void by_joint_state(StateJacobian& columns, const InsBody& body, const JointKinematicState& q,
                    const JointPropagation& p, const InsState& parent, const JacobianColumnWriter& maker) {
  const Vec3 none = Vec3::Zero();
  if (body.motion == JointMotion::revolute) {
    put_rotation(columns, 0, p, parent, maker, p.axis, none);
    put_relative_velocity(columns, 1, p, maker, p.axis, none);
    put_relative_velocity(columns, 2, p, maker, none, p.axis);
  } else if (body.motion == JointMotion::prismatic) {
    const Vec3& a = p.axis_parent;
    maker.put(columns, 0, none, none,
              p.turn * (lever_matrix(parent.angular_velocity, parent.angular_acceleration) * a));
    maker.put(columns, 1, none, none, p.turn * (2.0 * parent.angular_velocity.cross(a)));
    maker.put(columns, 2, none, none, p.turn * a);
  } else if (body.motion == JointMotion::spherical) {
    by_spherical_joint(columns, body, q, p, parent, maker);
  }
}

}  // namespace

Index degrees_of_freedom(JointMotion motion) {
  return motion == JointMotion::spherical ? 3 : motion == JointMotion::fixed ? 0 : 1;
}

Index InsBody::turns() const {
  return std::ranges::count(free_parent_rotation, true) + std::ranges::count(free_child_rotation, true);
}

Index InsBody::unknowns() const {
  return turns() + (free_point_in_parent ? 3 : 0) + (free_point_in_child ? 3 : 0);
}

InsBody revolute_body(int parent, int sensor, const Mat3& parent_R_axis, const Mat3& child_R_axis) {
  InsBody body{.parent = parent, .sensor = sensor, .motion = JointMotion::revolute};
  body.parent_R_axis = parent_R_axis;
  body.child_R_axis = child_R_axis;
  body.free_parent_rotation = body.free_child_rotation = {true, true, false};  // rotation about the axis itself is q
  body.free_point_in_parent = body.free_point_in_child = true;
  return body;
}

InsBody prismatic_body(int parent, int sensor, const Mat3& parent_R_axis, const Mat3& child_R_axis) {
  InsBody body{.parent = parent, .sensor = sensor, .motion = JointMotion::prismatic};
  body.parent_R_axis = parent_R_axis;
  body.child_R_axis = child_R_axis;
  body.free_parent_rotation = {true, true, false};
  body.free_child_rotation = {true, true, true};
  body.free_point_in_parent = true;  // c is fixed: the position of a prismatic axis is a gauge freedom
  return body;
}

InsBody spherical_body(int parent, int sensor, const Mat3& parent_R_child) {
  InsBody body{.parent = parent, .sensor = sensor, .motion = JointMotion::spherical};
  body.child_R_axis = parent_R_child.transpose();
  body.free_point_in_parent = body.free_point_in_child = true;
  return body;
}

InsBody fixed_body(int parent, int sensor, const Mat3& parent_R_child) {
  InsBody body{.parent = parent, .sensor = sensor};
  body.child_R_axis = parent_R_child.transpose();
  body.free_child_rotation = {true, true, true};
  body.free_point_in_parent = true;
  return body;
}

InsBody retract(const InsBody& body, ConstVectorRef step) {
  KINFER_EXPECT(step.size() == body.unknowns());
  InsBody result = body;
  Index k = 0;
  const auto turn = [&](const std::array<bool, 3>& is_free) {
    Vec3 v = Vec3::Zero();
    for (std::size_t i = 0; i < 3; ++i)
      if (is_free[i]) v[static_cast<Index>(i)] = step[k++];
    return exp_so3(v);
  };
  result.parent_R_axis *= turn(body.free_parent_rotation);
  result.child_R_axis *= turn(body.free_child_rotation);
  if (body.free_point_in_parent) result.point_in_parent += step.segment<3>(k), k += 3;
  if (body.free_point_in_child) result.point_in_child += step.segment<3>(k);
  return result;
}

InsState propagated(const InsBody& body, const JointKinematicState& q, const InsState& parent) {
  return propagate_through_joint(body, q, parent).child;
}

void propagate(const InsBody& body, const JointKinematicState& q, const InsState& parent, PropagatedDerivative& out) {
  const JointPropagation p = propagate_through_joint(body, q, parent);
  const JacobianColumnWriter maker{p, body.point_in_child,
                                   lever_by_angular_velocity(p.child.angular_velocity, body.point_in_child)};
  out.state = p.child;
  by_parent_state(p, parent, maker, out.by_parent);
  Index k = 3 * degrees_of_freedom(body.motion);
  out.by_own.resize(state_size, k + body.unknowns());
  by_joint_state(out.by_own, body, q, p, parent, maker);
  const Mat3 lever = lever_matrix(parent.angular_velocity, parent.angular_acceleration);
  const Mat3 child_R_turned = p.turn * body.parent_R_axis;  // B Rz(−q)
  for (int i = 0; i < 3; ++i)
    if (body.free_parent_rotation[static_cast<std::size_t>(i)]) {
      const Vec3 axis_change = body.parent_R_axis * Vec3::Unit(i).cross(Vec3::UnitZ());
      const double s = p.arm_acceleration.dot(p.axis_parent), v = p.arm_velocity.dot(p.axis_parent);
      const double slid = body.motion == JointMotion::prismatic ? q[0].x() : 0.0;
      const Vec3 joint =
          lever * (slid * axis_change) + 2.0 * v * parent.angular_velocity.cross(axis_change) + s * axis_change;
      put_rotation(out.by_own, k++, p, parent, maker, child_R_turned.col(i), p.turn * joint);
    }
  for (int i = 0; i < 3; ++i)
    if (body.free_child_rotation[static_cast<std::size_t>(i)]) {
      const Vec3 b = body.child_R_axis.col(i);
      maker.put(out.by_own, k++, b.cross(p.child.angular_velocity), b.cross(p.child.angular_acceleration),
                b.cross(p.force_at_joint));
    }
  if (body.free_point_in_parent) {
    out.by_own.middleCols<3>(k).setZero();
    out.by_own.block<3, 3>(6, k) = p.turn * lever;
    k += 3;
  }
  if (body.free_point_in_child) {
    out.by_own.middleCols<3>(k).setZero();
    out.by_own.block<3, 3>(6, k) = -lever_matrix(p.child.angular_velocity, p.child.angular_acceleration);
  }
}

}  // namespace kinfer
