// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot/mjcf/mjcf_orientation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kinfer {
namespace {

using std::numbers::pi;
constexpr double no_direction = 1e-9;    // [1] shorter vectors are zeros
constexpr double same_rotation = 1e-13;  // [1] numbers that mean a rotation to this are exact

Vec3 vector_at(std::span<const double> numbers, std::size_t first) {
  return {numbers[first], numbers[first + 1], numbers[first + 2]};
}

/// Unit vector, also of numbers whose squares overflow.
std::optional<Vec3> direction_of(const Vec3& v) {
  if (!(v.stableNorm() > no_direction)) return std::nullopt;
  return v.stableNormalized();
}

int axis_index(char letter) {
  return std::tolower(static_cast<unsigned char>(letter)) - 'x';
}

Mat3 elementary_rotation(char letter, double angle) {
  return exp_so3(angle * Vec3::Unit(axis_index(letter)));
}

/// Indices of the letters in the order in which their rotations stand in the product, from the left: a rotation about
/// a moving axis is appended, one about a fixed axis put in front.
std::vector<std::size_t> product_order(std::string_view sequence) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < sequence.size(); ++i)
    order.insert(std::islower(static_cast<unsigned char>(sequence[i])) ? order.end() : order.begin(), i);
  return order;
}

Mat3 from_euler_sequence(std::string_view sequence, const Vec3& angles) {
  Mat3 r = Mat3::Identity();
  for (const std::size_t i : product_order(sequence))
    r = r * elementary_rotation(sequence[i], angles[static_cast<Eigen::Index>(i)]);
  return r;
}

std::optional<Mat3> from_quaternion(std::span<const double> n) {
  const Eigen::Vector4d q(n[0], n[1], n[2], n[3]);
  if (!(q.stableNorm() > no_direction)) return std::nullopt;
  const Eigen::Vector4d unit = q.stableNormalized();
  return Quat(unit[0], unit[1], unit[2], unit[3]).toRotationMatrix();
}

std::optional<Mat3> from_axis_angle(std::span<const double> n, double unit) {
  const auto axis = direction_of(vector_at(n, 0));
  if (!axis) return std::nullopt;
  return exp_so3(unit * n[3] * *axis);
}

std::optional<Mat3> from_two_axes(std::span<const double> n) {
  const auto x = direction_of(vector_at(n, 0)), y = direction_of(vector_at(n, 3));
  if (!x || !y) return std::nullopt;
  const auto perpendicular = direction_of(*y - x->dot(*y) * *x);
  if (!perpendicular) return std::nullopt;
  Mat3 r;
  r << *x, *perpendicular, x->cross(*perpendicular);
  return r;
}

/// The smallest rotation; of directions opposite to z half a turn about x.
Mat3 from_z_axis(const Vec3& z) {
  const Vec3 across = Vec3::UnitZ().cross(z);
  const double sine = across.norm();
  const Vec3 axis = sine < 1e-10 ? Vec3::UnitX() : Vec3(across / sine);
  return exp_so3(std::atan2(sine, z.z()) * axis);
}

double nearest_turn(double angle, double like) {
  return angle - 2.0 * pi * std::round((angle - like) / (2.0 * pi));
}

std::vector<double> quaternion_numbers(const Mat3& r, std::span<const double> like) {
  const Quat q(r);
  const double dot = q.w() * like[0] + q.vec().dot(vector_at(like, 1)), sign = dot < 0.0 ? -1.0 : 1.0;
  return {sign * q.w(), sign * q.x(), sign * q.y(), sign * q.z()};
}

std::vector<double> axis_angle_numbers(const Mat3& r, std::span<const double> like, double unit) {
  const Vec3 old_axis = direction_of(vector_at(like, 0)).value_or(Vec3::UnitZ()), turn = log_so3(r);
  double angle = turn.norm();
  Vec3 axis = angle > 0.0 ? Vec3(turn / angle) : old_axis;
  if (axis.dot(old_axis) < 0.0) axis = -axis, angle = -angle;
  return {axis.x(), axis.y(), axis.z(), nearest_turn(angle, unit * like[3]) / unit};
}

/// Both triples of angles that mean R; empty where the sequence has the same axis twice in a row.
std::vector<Vec3> euler_angles(std::string_view sequence, const Mat3& r) {
  const std::vector<std::size_t> order = product_order(sequence);
  int axis[3];
  for (int k = 0; k < 3; ++k) axis[k] = axis_index(sequence[order[k]]);
  if (axis[0] == axis[1] || axis[1] == axis[2]) return {};
  const Vec3 one = r.eulerAngles(axis[0], axis[1], axis[2]);
  const Vec3 other(one[0] + pi, (axis[0] == axis[2] ? 0.0 : pi) - one[1], one[2] + pi);
  std::vector<Vec3> both(2);
  for (int k = 0; k < 3; ++k) {
    both[0][static_cast<Eigen::Index>(order[k])] = one[k];
    both[1][static_cast<Eigen::Index>(order[k])] = other[k];
  }
  return both;
}

std::optional<std::vector<double>> euler_numbers(const Mat3& r, std::span<const double> like, const MjcfUnits& units) {
  const Vec3 old = units.angle() * vector_at(like, 0);
  std::vector<Vec3> both = euler_angles(units.euler_sequence, r);
  if (both.empty()) return std::nullopt;
  for (Vec3& angles : both)
    for (int k = 0; k < 3; ++k) angles[k] = nearest_turn(angles[k], old[k]);
  const Vec3 near = ((both[0] - old).norm() <= (both[1] - old).norm() ? both[0] : both[1]) / units.angle();
  return std::vector<double>{near.x(), near.y(), near.z()};
}

std::optional<std::vector<double>> possible_numbers(MjcfOrientation kind, const Mat3& r, std::span<const double> like,
                                                    const MjcfUnits& units) {
  switch (kind) {
    case MjcfOrientation::none:
      return std::nullopt;
    case MjcfOrientation::quat:
      return quaternion_numbers(r, like);
    case MjcfOrientation::axisangle:
      return axis_angle_numbers(r, like, units.angle());
    case MjcfOrientation::xyaxes:
      return std::vector<double>(r.data(), r.data() + 6);  // the first two columns
    case MjcfOrientation::zaxis:
      return std::vector<double>(r.data() + 6, r.data() + 9);
    case MjcfOrientation::euler:
      return euler_numbers(r, like, units);
  }
  return std::nullopt;
}

}  // namespace

bool is_euler_sequence(std::string_view text) {
  return text.size() == 3 && text.find_first_not_of("xyzXYZ") == std::string_view::npos;
}

std::optional<Mat3> rotation_of(MjcfOrientation kind, std::span<const double> n, const MjcfUnits& units) {
  switch (kind) {
    case MjcfOrientation::none:
      return Mat3::Identity();
    case MjcfOrientation::quat:
      return from_quaternion(n);
    case MjcfOrientation::axisangle:
      return from_axis_angle(n, units.angle());
    case MjcfOrientation::xyaxes:
      return from_two_axes(n);
    case MjcfOrientation::zaxis: {
      const auto z = direction_of(vector_at(n, 0));
      return z ? std::optional(from_z_axis(*z)) : std::nullopt;
    }
    case MjcfOrientation::euler:
      return from_euler_sequence(units.euler_sequence, units.angle() * vector_at(n, 0));
  }
  return std::nullopt;
}

std::optional<std::vector<double>> numbers_of(MjcfOrientation kind, const Mat3& r, std::span<const double> like,
                                              const MjcfUnits& units) {
  auto numbers = possible_numbers(kind, r, like, units);
  if (!numbers) return std::nullopt;
  const auto meant = rotation_of(kind, *numbers, units);
  const bool is_exact = meant && (*meant - r).cwiseAbs().maxCoeff() < same_rotation;
  return is_exact ? numbers : std::nullopt;
}

}  // namespace kinfer
