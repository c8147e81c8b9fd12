// SPDX-License-Identifier: Apache-2.0
// A convention is an order of elementary motions. This file is the only place that defines the order of each.
//
// A visitor is called with every Factor (a rotation about or a translation along one axis of the current frame) and
// with every constant rotation, from the base outwards. Poses, Jacobians, derivatives and programs are visitors.
#pragma once

#include <cmath>
#include <optional>

#include "kinfer/kinematics/parameters.hpp"

namespace kinfer::elementary {

struct Factor {
  Motion motion = Motion::rotation;
  int axis = 0;                ///< 0, 1, 2: x, y, z
  double value = 0.0;          ///< [rad] or [m]
  std::optional<Field> field;  ///< the chain parameter that `value` is; none for the motion of a URDF joint
  bool moves = false;          ///< the displacement of the joint is added to `value`
};

/// pose = pose · Rot(axis, angle), by cosine and sine of the angle.
inline void rotate(Pose& pose, int axis, double c, double s) {
  const int i = axis == 2 ? 0 : axis + 1, j = 3 - axis - i;
  const Vec3 u = pose.rotation.col(i), v = pose.rotation.col(j);
  pose.rotation.col(i) = c * u + s * v;
  pose.rotation.col(j) = c * v - s * u;
}

/// pose = pose · Trans(axis, length)
inline void translate(Pose& pose, int axis, double length) {
  pose.position += length * pose.rotation.col(axis);
}

inline void apply(Pose& pose, Motion motion, int axis, double value) {
  if (motion == Motion::rotation) {
    rotate(pose, axis, std::cos(value), std::sin(value));
  } else {
    translate(pose, axis, value);
  }
}

template <class Visitor>
void for_each_factor(const Frame& frame, Visitor&& visit) {
  visit(Factor{Motion::translation, 0, frame.xyz.x(), Field::x});
  visit(Factor{Motion::translation, 1, frame.xyz.y(), Field::y});
  visit(Factor{Motion::translation, 2, frame.xyz.z(), Field::z});
  visit(frame.rotation);
  visit(Factor{Motion::rotation, 0, frame.small_rotation.x(), Field::rx});
  visit(Factor{Motion::rotation, 1, frame.small_rotation.y(), Field::ry});
  visit(Factor{Motion::rotation, 2, frame.small_rotation.z(), Field::rz});
}

template <class Visitor>
void for_each_factor(const DhLink& link, JointType type, Visitor&& visit) {
  visit(Factor{Motion::rotation, 2, link.theta, Field::theta, rotates(type)});
  visit(Factor{Motion::translation, 2, link.d, Field::d, translates(type)});
  visit(Factor{Motion::translation, 0, link.a, Field::a});
  visit(Factor{Motion::rotation, 0, link.alpha, Field::alpha});
  visit(Factor{Motion::rotation, 1, link.beta, Field::beta});
}

template <class Visitor>
void for_each_factor(const MdhLink& link, JointType type, Visitor&& visit) {
  visit(Factor{Motion::rotation, 0, link.alpha, Field::alpha});
  visit(Factor{Motion::translation, 0, link.a, Field::a});
  visit(Factor{Motion::rotation, 1, link.beta, Field::beta});
  visit(Factor{Motion::rotation, 2, link.theta, Field::theta, rotates(type)});
  visit(Factor{Motion::translation, 2, link.d, Field::d, translates(type)});
}

/// Rotation matrix that maps z to `axis`; the identity where it is z already.
inline Mat3 rotation_to(const Vec3& axis) {
  if (axis == Vec3::UnitZ()) return Mat3::Identity();
  const Vec3 u = any_perpendicular(axis);
  return (Mat3() << u, axis.cross(u), axis).finished();
}

template <class Visitor>
void for_each_factor(const UrdfLink& link, JointType type, Visitor&& visit) {
  for_each_factor(link.origin, visit);
  if (!has_position(type)) return;
  const Mat3 joint_R_axis = rotation_to(link.axis);
  visit(joint_R_axis);
  visit(Factor{*traits(type).motion, 2, 0.0, std::nullopt, true});
  visit(Mat3(joint_R_axis.transpose()));
}

template <class Visitor>
void for_each_factor(const Joint& joint, Visitor&& visit) {
  std::visit([&](const auto& link) { for_each_factor(link, joint.type, visit); }, joint.link);
}

}  // namespace kinfer::elementary
