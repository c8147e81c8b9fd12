// A convention is an order of elementary motions: this page is the only place that knows the order of each.
//
// A visitor is called with every Factor (a turn about or a shift along one axis of the frame reached so far) and with
// every constant rotation, from the base outwards. Poses, Jacobians, derivatives and programs are visitors.
#pragma once

#include <cmath>
#include <optional>

#include "kinfer/kinematics/parameters.hpp"

namespace kinfer::elementary {

enum class Motion { turn, shift };

struct Factor {
  Motion motion = Motion::turn;
  int axis = 0;                ///< 0, 1, 2: x, y, z
  double value = 0.0;          ///< [rad] or [m]
  std::optional<Field> field;  ///< which number of the chain `value` is; none for the motion of a URDF joint
  bool moves = false;          ///< the joint's reading, couplings and deflection are added to `value`
};

/// pose = pose · Rot(axis, angle), by cosine and sine of the angle.
inline void turn(Pose& pose, int axis, double c, double s) {
  const int i = axis == 2 ? 0 : axis + 1, j = 3 - axis - i;
  const Vec3 u = pose.rotation.col(i), v = pose.rotation.col(j);
  pose.rotation.col(i) = c * u + s * v;
  pose.rotation.col(j) = c * v - s * u;
}

/// pose = pose · Trans(axis, length)
inline void shift(Pose& pose, int axis, double length) {
  pose.position += length * pose.rotation.col(axis);
}

inline void apply(Pose& pose, Motion motion, int axis, double value) {
  if (motion == Motion::turn) {
    turn(pose, axis, std::cos(value), std::sin(value));
  } else {
    shift(pose, axis, value);
  }
}

template <class Visitor>
void for_each_factor(const Frame& frame, Visitor&& visit) {
  visit(Factor{Motion::shift, 0, frame.xyz.x(), Field::x});
  visit(Factor{Motion::shift, 1, frame.xyz.y(), Field::y});
  visit(Factor{Motion::shift, 2, frame.xyz.z(), Field::z});
  visit(frame.rotation);
  visit(Factor{Motion::turn, 0, frame.turn.x(), Field::rx});
  visit(Factor{Motion::turn, 1, frame.turn.y(), Field::ry});
  visit(Factor{Motion::turn, 2, frame.turn.z(), Field::rz});
}

template <class Visitor>
void for_each_factor(const DhLink& link, JointType type, Visitor&& visit) {
  visit(Factor{Motion::turn, 2, link.theta, Field::theta, type == JointType::revolute});
  visit(Factor{Motion::shift, 2, link.d, Field::d, type == JointType::prismatic});
  visit(Factor{Motion::shift, 0, link.a, Field::a});
  visit(Factor{Motion::turn, 0, link.alpha, Field::alpha});
  visit(Factor{Motion::turn, 1, link.beta, Field::beta});
}

template <class Visitor>
void for_each_factor(const MdhLink& link, JointType type, Visitor&& visit) {
  visit(Factor{Motion::turn, 0, link.alpha, Field::alpha});
  visit(Factor{Motion::shift, 0, link.a, Field::a});
  visit(Factor{Motion::turn, 1, link.beta, Field::beta});
  visit(Factor{Motion::turn, 2, link.theta, Field::theta, type == JointType::revolute});
  visit(Factor{Motion::shift, 2, link.d, Field::d, type == JointType::prismatic});
}

/// A rotation that takes z to `axis`; the identity where it is z already.
inline Mat3 rotation_to(const Vec3& axis) {
  if (axis == Vec3::UnitZ()) return Mat3::Identity();
  const Vec3 u = any_perpendicular(axis);
  return (Mat3() << u, axis.cross(u), axis).finished();
}

template <class Visitor>
void for_each_factor(const UrdfLink& link, JointType type, Visitor&& visit) {
  for_each_factor(link.origin, visit);
  if (type == JointType::fixed) return;
  const Mat3 joint_R_axis = rotation_to(link.axis);
  visit(joint_R_axis);
  visit(Factor{type == JointType::revolute ? Motion::turn : Motion::shift, 2, 0.0, std::nullopt, true});
  visit(Mat3(joint_R_axis.transpose()));
}

template <class Visitor>
void for_each_factor(const Joint& joint, Visitor&& visit) {
  std::visit([&](const auto& link) { for_each_factor(link, joint.type, visit); }, joint.link);
}

}  // namespace kinfer::elementary
