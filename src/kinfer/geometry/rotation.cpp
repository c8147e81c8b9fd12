// SPDX-License-Identifier: Apache-2.0
#include "kinfer/geometry/rotation.hpp"

#include <cctype>
#include <cmath>
#include <numbers>
#include <string>

#include "kinfer/base/expect.hpp"

namespace kinfer {
namespace {

constexpr double gimbal_lock = 1e-12;     // cosine below which the outer and the inner axis coincide to rounding
constexpr double opposite = -1.0 + 1e-8;  // cosine c below which 1 + c has lost half of its digits
constexpr double small_angle = 1e-4;      // [rad]; below, the series' next term is under 1e-17

}  // namespace

Mat3 skew(const Vec3& v) {
  Mat3 m;
  // clang-format off
  m <<     0, -v.z(),  v.y(),
       v.z(),      0, -v.x(),
      -v.y(),  v.x(),      0;
  // clang-format on
  return m;
}

Mat3 rot_x(double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return (Mat3() << 1, 0, 0, 0, c, -s, 0, s, c).finished();
}

Mat3 rot_y(double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return (Mat3() << c, 0, s, 0, 1, 0, -s, 0, c).finished();
}

Mat3 rot_z(double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return (Mat3() << c, -s, 0, s, c, 0, 0, 0, 1).finished();
}

Mat3 exp_so3(const Vec3& v) {
  const double angle2 = v.squaredNorm(), angle = std::sqrt(angle2);
  const bool small = angle < small_angle;
  const double a = small ? 1.0 - angle2 / 6.0 : std::sin(angle) / angle;
  const double half = std::sin(angle / 2.0);
  const double b = small ? 0.5 - angle2 / 24.0 : 2.0 * half * half / angle2;
  const Mat3 k = skew(v);
  return Mat3::Identity() + a * k + b * k * k;
}

Quat quat_exp(const Vec3& v) {
  const double half = v.norm() / 2.0;
  const double s = half < small_angle ? 0.5 - half * half / 12.0 : std::sin(half) / (2.0 * half);
  return Quat(std::cos(half), s * v.x(), s * v.y(), s * v.z());
}

Vec3 quat_log(const Quat& q) {
  const double sign = q.w() < 0 ? -1.0 : 1.0;
  const double w = sign * q.w(), n = q.vec().norm();
  const double scale = n < small_angle * 1e-4 ? 2.0 / w : 2.0 * std::atan2(n, w) / n;
  return sign * scale * q.vec();
}

Vec3 log_so3(const Mat3& r) {
  return quat_log(Quat(r).normalized());
}

Mat3 right_jacobian(const Vec3& v) {
  const double angle2 = v.squaredNorm(), angle = std::sqrt(angle2);
  const bool small = angle < small_angle;
  const double half = std::sin(angle / 2.0);  // 1 − cos would lose half of the digits of a small angle
  const double a = small ? 0.5 - angle2 / 24.0 : 2.0 * half * half / angle2;
  const double b = small ? 1.0 / 6.0 - angle2 / 120.0 : (angle - std::sin(angle)) / (angle2 * angle);
  const Mat3 k = skew(v);
  return Mat3::Identity() - a * k + b * k * k;
}

Mat3 right_jacobian_inverse(const Vec3& v) {
  const double angle2 = v.squaredNorm(), angle = std::sqrt(angle2);
  const double c =
      angle < small_angle ? 1.0 / 12.0 + angle2 / 720.0 : (1.0 - angle / 2.0 / std::tan(angle / 2.0)) / angle2;
  const Mat3 k = skew(v);
  return Mat3::Identity() + 0.5 * k + c * k * k;
}

Mat3 from_rpy(const Vec3& rpy) {
  return rot_z(rpy.z()) * rot_y(rpy.y()) * rot_x(rpy.x());
}

Vec3 to_rpy(const Mat3& r) {
  const double cos_pitch = std::hypot(r(0, 0), r(1, 0));
  const double pitch = std::atan2(-r(2, 0), cos_pitch);
  if (cos_pitch < gimbal_lock) return {0.0, pitch, std::atan2(-r(0, 1), r(1, 1))};
  // Roll is computed after removing this yaw: near gimbal lock each is ill determined, but not their combination.
  const double yaw = std::atan2(r(1, 0), r(0, 0)), c = std::cos(yaw), s = std::sin(yaw);
  return {std::atan2(s * r(0, 2) - c * r(1, 2), c * r(1, 1) - s * r(0, 1)), pitch, yaw};
}

Vec3 to_intrinsic_xyz(const Mat3& r) {
  const double cosine = std::hypot(r(0, 0), r(0, 1));
  const double b = std::atan2(r(0, 2), cosine);
  if (cosine < gimbal_lock) return {std::atan2(r(2, 1), r(1, 1)), b, 0.0};
  return {std::atan2(-r(1, 2), r(2, 2)), b, std::atan2(-r(0, 1), r(0, 0))};
}

std::optional<EulerSequence> parse_euler_sequence(std::string_view text) {
  if (text.size() < 3) return std::nullopt;
  EulerSequence sequence;
  for (int i = 0; i < 3; ++i) {
    sequence.axes[i] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[i])));
    if (sequence.axes[i] < 'X' || sequence.axes[i] > 'Z') return std::nullopt;
    if (i > 0 && sequence.axes[i] == sequence.axes[i - 1]) return std::nullopt;
  }
  const std::string_view kind = text.substr(3);
  if (kind != " intrinsic" && kind != " extrinsic") return std::nullopt;
  sequence.intrinsic = kind == " intrinsic";
  return sequence;
}

Mat3 from_euler(const EulerSequence& sequence, const Vec3& angles) {
  Mat3 r = Mat3::Identity();
  for (int i = 0; i < 3; ++i) {
    const char axis = sequence.axes[i];
    const Mat3 step = axis == 'X' ? rot_x(angles[i]) : axis == 'Y' ? rot_y(angles[i]) : rot_z(angles[i]);
    r = sequence.intrinsic ? Mat3(r * step) : Mat3(step * r);
  }
  return r;
}

Quat rotation_between(const Vec3& from, const Vec3& to) {
  const Vec3 a = from.normalized(), b = to.normalized();
  const double cosine = b.dot(a);
  if (cosine < opposite) {
    const Vec3 axis = any_perpendicular(a);
    return rotation_between(-a, b) * Quat(0.0, axis.x(), axis.y(), axis.z());
  }
  const Vec3 sine = a.cross(b);
  const double twice = std::sqrt((1.0 + cosine) * 2.0);  // twice the cosine of half the angle
  const double scale = 1.0 / twice;
  return Quat(twice * 0.5, sine.x() * scale, sine.y() * scale, sine.z() * scale);
}

Vec3 any_perpendicular(const Vec3& v) {
  Eigen::Index smallest;
  v.cwiseAbs().minCoeff(&smallest);
  return v.cross(Vec3::Unit(smallest)).normalized();
}

Mat3 frame_with_z_along(const Vec3& axis) {
  Mat3 frame;
  frame.col(2) = axis.normalized();
  frame.col(0) = any_perpendicular(axis).normalized();
  frame.col(1) = frame.col(2).cross(frame.col(0));
  return frame;
}

double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

double angle_between(const Mat3& a, const Mat3& b) {
  return log_so3(a.transpose() * b).norm();
}

}  // namespace kinfer
