#include "kinfer/estimate/ins_chain.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/expect.hpp"
#include "kinfer/estimate/rotation_rate.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;

/// K with f(r) = f(0) + K r: skew(ω̇) + skew(ω)².
Mat3 lever_effect(const Vec3& rate, const Vec3& rate_change) {
  const Mat3 w = skew(rate);
  return skew(rate_change) + w * w;
}

/// What a joint does at one time, as both functions below need it.
struct Passage {
  Mat3 turn;                       // child_R_parent
  Vec3 axis_parent, axis;          // in the parent, in the child
  Vec3 spin, spin_change;          // of the child against the parent, in the child
  Vec3 arm, arm_rate, arm_change;  // d and its derivatives, in the parent
  Vec3 rate_in_child;              // R ω
  Vec3 force_at_joint;             // R f_J
  InsState child;
};

Mat3 turned_back(const InsBody& body, const Vec3& q) {
  if (body.motion == JointMotion::turn) return rot_z(-q.x());
  if (body.motion == JointMotion::ball) return exp_so3(-q);
  return Mat3::Identity();
}

void spin(Passage& p, const InsBody& body, const JointReading& q) {
  p.spin = p.spin_change = Vec3::Zero();
  if (body.motion == JointMotion::turn) {
    p.spin = q[1].x() * p.axis;
    p.spin_change = q[2].x() * p.axis;
  } else if (body.motion == JointMotion::ball) {
    const RotationRate r = rotation_rate(q[0], q[1], q[2]);
    p.spin = body.child_R_axis * r.rate;
    p.spin_change = body.child_R_axis * r.rate_change;
  }
}

Passage pass(const InsBody& body, const JointReading& q, const InsState& parent) {
  Passage p;
  const double slides = body.motion == JointMotion::slide ? 1.0 : 0.0;
  p.axis_parent = body.parent_R_axis.col(2);
  p.axis = body.child_R_axis.col(2);
  p.turn = body.child_R_axis * turned_back(body, q[0]) * body.parent_R_axis.transpose();
  spin(p, body, q);
  p.arm = body.point_in_parent + slides * q[0].x() * p.axis_parent;
  p.arm_rate = slides * q[1].x() * p.axis_parent;
  p.arm_change = slides * q[2].x() * p.axis_parent;
  const Vec3 at_joint = parent.force + parent.rate_change.cross(p.arm) + parent.rate.cross(parent.rate.cross(p.arm)) +
                        2.0 * parent.rate.cross(p.arm_rate) + p.arm_change;
  p.force_at_joint = p.turn * at_joint;
  p.rate_in_child = p.turn * parent.rate;
  p.child.rate = p.rate_in_child + p.spin;
  p.child.rate_change = p.turn * parent.rate_change + p.spin_change - p.spin.cross(p.rate_in_child);
  const Vec3& c = body.point_in_child;
  p.child.force = p.force_at_joint - p.child.rate_change.cross(c) - p.child.rate.cross(p.child.rate.cross(c));
  p.child.field = p.turn * parent.field;
  return p;
}

/// One column of derivatives from those of rate, rate change, force at the joint (in the child) and field.
struct ColumnMaker {
  const Passage& p;
  const Vec3& c;
  Mat3 by_rate;  // of f_c by ω_c

  void put(StateColumns& columns, Index column, const Vec3& rate, const Vec3& rate_change, const Vec3& force_at_joint,
           const Vec3& field) const {
    columns.col(column) << rate, rate_change, force_at_joint - rate_change.cross(c) + by_rate * rate, field;
  }
};

Mat3 lever_by_rate(const Vec3& rate, const Vec3& arm) {  // −d(ω × (ω × r))/dω
  return skew(rate.cross(arm)) + skew(rate) * skew(arm);
}

void by_parent_state(const Passage& p, const InsState& parent, const ColumnMaker& maker,
                     Eigen::Matrix<double, 12, 12>& by_parent) {
  const Mat3& r = p.turn;
  by_parent.setZero();
  by_parent.block<3, 3>(0, 0) = r;
  by_parent.block<3, 3>(3, 0) = -skew(p.spin) * r;
  by_parent.block<3, 3>(3, 3) = r;
  const Mat3 joint_by_rate = -lever_by_rate(parent.rate, p.arm) - 2.0 * skew(p.arm_rate);
  const Mat3 arm = skew(maker.c);
  by_parent.block<3, 3>(6, 0) = r * joint_by_rate + arm * by_parent.block<3, 3>(3, 0) + maker.by_rate * r;
  by_parent.block<3, 3>(6, 3) = -r * skew(p.arm) + arm * r;
  by_parent.block<3, 3>(6, 6) = r;
  by_parent.block<3, 3>(9, 9) = r;
}

/// The parent's frame seen from the child turns by −m for a small turn of the joint about m (in the child).
void put_turn(StateColumns& columns, Index column, const Passage& p, const InsState& parent, const ColumnMaker& maker,
              const Vec3& m, const Vec3& joint_force_change) {
  const Vec3 rate = -m.cross(p.rate_in_child);
  const Vec3 rate_change = -m.cross(p.turn * parent.rate_change) - p.spin.cross(rate);
  maker.put(columns, column, rate, rate_change, -m.cross(p.force_at_joint) + joint_force_change,
            -m.cross(p.child.field));
}

/// A change of the spin and of its derivative by time.
void put_spin(StateColumns& columns, Index column, const Passage& p, const ColumnMaker& maker, const Vec3& change,
              const Vec3& change_of_change) {
  maker.put(columns, column, change, change_of_change - change.cross(p.rate_in_child), Vec3::Zero(), Vec3::Zero());
}

void by_ball(StateColumns& columns, const InsBody& body, const JointReading& q, const Passage& p,
             const InsState& parent, const ColumnMaker& maker) {
  const RotationRate r = rotation_rate(q[0], q[1], q[2]);
  const Mat3& b = body.child_R_axis;
  for (Index i = 0; i < 3; ++i) {
    const Vec3 turn = b * r.jacobian.col(i);
    put_spin(columns, 3 * i, p, maker, b * r.rate_by_vector.col(i), b * r.change_by_vector.col(i));
    const Eigen::Matrix<double, 12, 1> of_spin = columns.col(3 * i);
    put_turn(columns, 3 * i, p, parent, maker, turn, Vec3::Zero());
    columns.col(3 * i) += of_spin;
    put_spin(columns, 3 * i + 1, p, maker, turn, b * r.change_by_rate.col(i));
    put_spin(columns, 3 * i + 2, p, maker, Vec3::Zero(), turn);
  }
}

void by_reading(StateColumns& columns, const InsBody& body, const JointReading& q, const Passage& p,
                const InsState& parent, const ColumnMaker& maker) {
  const Vec3 none = Vec3::Zero();
  if (body.motion == JointMotion::turn) {
    put_turn(columns, 0, p, parent, maker, p.axis, none);
    put_spin(columns, 1, p, maker, p.axis, none);
    put_spin(columns, 2, p, maker, none, p.axis);
  } else if (body.motion == JointMotion::slide) {
    const Vec3& a = p.axis_parent;
    maker.put(columns, 0, none, none, p.turn * (lever_effect(parent.rate, parent.rate_change) * a), none);
    maker.put(columns, 1, none, none, p.turn * (2.0 * parent.rate.cross(a)), none);
    maker.put(columns, 2, none, none, p.turn * a, none);
  } else if (body.motion == JointMotion::ball) {
    by_ball(columns, body, q, p, parent, maker);
  }
}

}  // namespace

Index freedoms(JointMotion motion) {
  return motion == JointMotion::ball ? 3 : motion == JointMotion::none ? 0 : 1;
}

Index InsBody::turns() const {
  return std::ranges::count(free_parent_turn, true) + std::ranges::count(free_child_turn, true);
}

Index InsBody::unknowns() const {
  return turns() + (free_point_in_parent ? 3 : 0) + (free_point_in_child ? 3 : 0);
}

InsBody turning_body(int parent, int sensor, const Mat3& parent_R_axis, const Mat3& child_R_axis) {
  InsBody body{.parent = parent, .sensor = sensor, .motion = JointMotion::turn};
  body.parent_R_axis = parent_R_axis;
  body.child_R_axis = child_R_axis;
  body.free_parent_turn = body.free_child_turn = {true, true, false};  // about the axis itself: q does that
  body.free_point_in_parent = body.free_point_in_child = true;
  return body;
}

InsBody sliding_body(int parent, int sensor, const Mat3& parent_R_axis, const Mat3& child_R_axis) {
  InsBody body{.parent = parent, .sensor = sensor, .motion = JointMotion::slide};
  body.parent_R_axis = parent_R_axis;
  body.child_R_axis = child_R_axis;
  body.free_parent_turn = {true, true, false};
  body.free_child_turn = {true, true, true};
  body.free_point_in_parent = true;  // c stays: the line of a slide may lie anywhere
  return body;
}

InsBody ball_body(int parent, int sensor, const Mat3& parent_R_child) {
  InsBody body{.parent = parent, .sensor = sensor, .motion = JointMotion::ball};
  body.child_R_axis = parent_R_child.transpose();
  body.free_point_in_parent = body.free_point_in_child = true;
  return body;
}

InsBody fixed_body(int parent, int sensor, const Mat3& parent_R_child) {
  InsBody body{.parent = parent, .sensor = sensor};
  body.child_R_axis = parent_R_child.transpose();
  body.free_child_turn = {true, true, true};
  body.free_point_in_parent = true;
  return body;
}

InsBody changed(const InsBody& body, ConstVectorRef step) {
  KINFER_EXPECT(step.size() == body.unknowns());
  InsBody result = body;
  Index k = 0;
  const auto turn = [&](const std::array<bool, 3>& is_free) {
    Vec3 v = Vec3::Zero();
    for (std::size_t i = 0; i < 3; ++i)
      if (is_free[i]) v[static_cast<Index>(i)] = step[k++];
    return exp_so3(v);
  };
  result.parent_R_axis *= turn(body.free_parent_turn);
  result.child_R_axis *= turn(body.free_child_turn);
  if (body.free_point_in_parent) result.point_in_parent += step.segment<3>(k), k += 3;
  if (body.free_point_in_child) result.point_in_child += step.segment<3>(k);
  return result;
}

InsState carried(const InsBody& body, const JointReading& q, const InsState& parent) {
  return pass(body, q, parent).child;
}

void carry(const InsBody& body, const JointReading& q, const InsState& parent, CarriedDerivative& out) {
  const Passage p = pass(body, q, parent);
  const ColumnMaker maker{p, body.point_in_child, lever_by_rate(p.child.rate, body.point_in_child)};
  out.state = p.child;
  by_parent_state(p, parent, maker, out.by_parent);
  Index k = 3 * freedoms(body.motion);
  out.by_own.resize(12, k + body.unknowns());
  by_reading(out.by_own, body, q, p, parent, maker);
  const Mat3 lever = lever_effect(parent.rate, parent.rate_change);
  const Mat3 child_R_turned = p.turn * body.parent_R_axis;  // B Rz(−q)
  for (int i = 0; i < 3; ++i)
    if (body.free_parent_turn[static_cast<std::size_t>(i)]) {
      const Vec3 axis_change = body.parent_R_axis * Vec3::Unit(i).cross(Vec3::UnitZ());
      const double s = p.arm_change.dot(p.axis_parent), v = p.arm_rate.dot(p.axis_parent);
      const double slid = body.motion == JointMotion::slide ? q[0].x() : 0.0;
      const Vec3 joint = lever * (slid * axis_change) + 2.0 * v * parent.rate.cross(axis_change) + s * axis_change;
      put_turn(out.by_own, k++, p, parent, maker, child_R_turned.col(i), p.turn * joint);
    }
  for (int i = 0; i < 3; ++i)
    if (body.free_child_turn[static_cast<std::size_t>(i)]) {
      const Vec3 b = body.child_R_axis.col(i);
      maker.put(out.by_own, k++, b.cross(p.child.rate), b.cross(p.child.rate_change), b.cross(p.force_at_joint),
                b.cross(p.child.field));
    }
  if (body.free_point_in_parent) {
    out.by_own.middleCols<3>(k).setZero();
    out.by_own.block<3, 3>(6, k) = p.turn * lever;
    k += 3;
  }
  if (body.free_point_in_child) {
    out.by_own.middleCols<3>(k).setZero();
    out.by_own.block<3, 3>(6, k) = -lever_effect(p.child.rate, p.child.rate_change);
  }
}

}  // namespace kinfer
