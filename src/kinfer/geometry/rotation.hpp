// SPDX-License-Identifier: Apache-2.0
// Rotations in three dimensions: exponential map, roll-pitch-yaw, Euler sequences; accurate near singularities.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string_view>

namespace kinfer {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaterniond;

/// skew(v) w = v × w
Mat3 skew(const Vec3& v);

Mat3 rot_x(double angle);  ///< [rad]
Mat3 rot_y(double angle);
Mat3 rot_z(double angle);

/// Rotation by |v| about v (Rodrigues); exact to rounding for small v too.
Mat3 exp_so3(const Vec3& rotation_vector);

/// Rotation vector of R with length in [0, π]. At π the sign of the axis is arbitrary.
Vec3 log_so3(const Mat3& r);

Quat quat_exp(const Vec3& rotation_vector);
Vec3 quat_log(const Quat& q);

/// d exp(v + dv) = exp(v) exp(J_r(v) dv): right Jacobian of SO(3) (Chirikjian 2011, eq. 10.86).
Mat3 right_jacobian(const Vec3& rotation_vector);
Mat3 right_jacobian_inverse(const Vec3& rotation_vector);

/// R = Rz(yaw) Ry(pitch) Rx(roll), as in URDF and docs/formats.md.
Mat3 from_rpy(const Vec3& roll_pitch_yaw);

/// Roll, pitch, yaw of R; at pitch = ±90° roll is set to 0 (only yaw ∓ roll is known there).
Vec3 to_rpy(const Mat3& r);

/// (a, b, c) of R = Rx(a) Ry(b) Rz(c); at b = ±90° c is set to 0.
Vec3 to_intrinsic_xyz(const Mat3& r);

/// Euler angles by the name of the sequence: "XYZ intrinsic" rotates about the moving axes in this order
/// (R = Rx(a) Ry(b) Rz(c)), "XYZ extrinsic" about the fixed ones (R = Rz(c) Ry(b) Rx(a)).
struct EulerSequence {
  char axes[3] = {'X', 'Y', 'Z'};
  bool intrinsic = true;
};
std::optional<EulerSequence> parse_euler_sequence(std::string_view text);
Mat3 from_euler(const EulerSequence& sequence, const Vec3& angles);

/// The smallest rotation that turns `from` into the direction of `to`, neither zero; of directions opposite to 1e-4 rad
/// half a turn about any perpendicular, to the same accuracy.
Quat rotation_between(const Vec3& from, const Vec3& to);

/// A unit vector perpendicular to v; continuous almost everywhere.
Vec3 any_perpendicular(const Vec3& v);

/// A rotation whose third column is the direction of `axis`.
Mat3 frame_with_z_along(const Vec3& axis);

/// Angle between two directions, [0, π]; accurate for small angles too.
double angle_between(const Vec3& a, const Vec3& b);

/// Angle of the rotation between two orientations, [0, π].
double angle_between(const Mat3& a, const Mat3& b);

}  // namespace kinfer
