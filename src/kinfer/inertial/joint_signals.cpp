// SPDX-License-Identifier: Apache-2.0
#include "kinfer/inertial/joint_signals.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinfer/base/angle.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/inertial/gaussian_smoothing.hpp"
#include "kinfer/inertial/thresholds.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer {
namespace {

/// Roll, pitch and yaw of a segment without jumps: beyond 90° of pitch the second Euler representation is used.
std::vector<Vec3> continuous_euler_angles(const SegmentMotion& segment) {
  std::vector<Vec3> angles;
  for (const Mat3& rotation : segment.rotation) {
    const Vec3 first = euler_angles(rotation);
    if (angles.empty()) {
      angles.push_back(first);
      continue;
    }
    const auto step_to = [&](const Vec3& candidate) {
      return Vec3((candidate - angles.back()).unaryExpr([](double x) { return wrap_to_pi(x); }));
    };
    const Vec3 step = step_to(first), other = step_to(alternative_euler_angles(first));
    angles.push_back(angles.back() + (other.norm() < step.norm() ? other : step));
  }
  return angles;
}

/// Rates of roll, pitch and yaw from the gyro: the inverse of ω_sensor = E(φ, θ) (φ', θ', ψ')ᵀ. At 90° of pitch this is
/// singular (gimbal lock); |cos θ| is bounded from below.
Vec3 euler_rates(const Vec3& angles, const Vec3& gyro) {
  const double s = std::sin(angles.x()), c = std::cos(angles.x());
  const double cosine = std::cos(angles.y());
  const double kept = std::copysign(std::max(std::abs(cosine), inertial::min_pitch_cosine), cosine);
  const double yaw = (s * gyro.y() + c * gyro.z()) / kept;
  return {gyro.x() + std::sin(angles.y()) * yaw, c * gyro.y() - s * gyro.z(), yaw};
}

JointSignal make_signal(std::string name, const std::vector<double>& angle, const std::vector<double>& angular_velocity,
                        const GaussianKernel& kernel) {
  return {std::move(name), smoothed(angle, kernel), smoothed(angular_velocity, kernel),
          smoothed_derivative(angular_velocity, kernel)};
}

/// Eqs. (18a)-(18c), and (19a)-(19c) with rates from the gyros instead of differentiated angles.
std::vector<JointSignal> euler_signals(const SegmentMotion& parent, const SegmentMotion& child,
                                       const GaussianKernel& kernel) {
  const std::vector<Vec3> of_parent = continuous_euler_angles(parent), of_child = continuous_euler_angles(child);
  std::vector<JointSignal> signals;
  for (int k = 0; k < 3; ++k) {
    std::vector<double> angle, angular_velocity;
    for (std::size_t i = 0; i < of_parent.size(); ++i) {
      angle.push_back(of_child[i][k] - of_parent[i][k]);
      angular_velocity.push_back(euler_rates(of_child[i], child.gyro[i])[k] -
                                 euler_rates(of_parent[i], parent.gyro[i])[k]);
    }
    const double turns = 2.0 * std::numbers::pi * std::round(angle.front() / (2.0 * std::numbers::pi));
    for (double& value : angle) value -= turns;
    signals.push_back(
        make_signal(std::array{"phi", "theta", "psi"}[static_cast<std::size_t>(k)], angle, angular_velocity, kernel));
  }
  return signals;
}

/// ω_rel = R_pc ω_c − ω_p in the parent's frame.
std::vector<Vec3> relative_rates(const SegmentMotion& parent, const SegmentMotion& child) {
  std::vector<Vec3> rates;
  for (std::size_t i = 0; i < parent.gyro.size(); ++i)
    rates.push_back(parent.rotation[i].transpose() * (child.rotation[i] * child.gyro[i]) - parent.gyro[i]);
  return rates;
}

/// Principal direction of the relative angular velocity; its largest component is positive.
Vec3 relative_rotation_axis(const std::vector<Vec3>& rates) {
  Mat3 spread = Mat3::Zero();
  for (const Vec3& angular_velocity : rates) spread += angular_velocity * angular_velocity.transpose();
  const Vec3 axis = symmetric_eigen(spread).vectors.col(2);
  Eigen::Index largest = 0;
  axis.cwiseAbs().maxCoeff(&largest);
  return axis[largest] < 0.0 ? Vec3(-axis) : axis;
}

/// Rotation angle of R_pc about `axis` relative to its first value: the twist of a swing-twist decomposition,
/// unwrapped.
JointSignal relative_rotation_signal(const SegmentMotion& parent, const SegmentMotion& child,
                                     const GaussianKernel& kernel) {
  const std::vector<Vec3> rates = relative_rates(parent, child);
  const Vec3 axis = relative_rotation_axis(rates);
  const auto relative = [&](std::size_t i) { return Quat(Mat3(parent.rotation[i].transpose() * child.rotation[i])); };
  const Quat home = relative(0);
  std::vector<double> angle, angular_velocity;
  for (std::size_t i = 0; i < rates.size(); ++i) {
    const Quat turn = relative(i) * home.conjugate();
    const double twist = 2.0 * std::atan2(axis.dot(turn.vec()), turn.w());
    angle.push_back(angle.empty() ? wrap_to_pi(twist) : angle.back() + wrap_to_pi(twist - angle.back()));
    angular_velocity.push_back(axis.dot(rates[i]));
  }
  return make_signal("q", angle, angular_velocity, kernel);
}

}  // namespace

Vec3 euler_angles(const Mat3& r) {
  return {std::atan2(r(2, 1), r(2, 2)), -std::asin(std::clamp(r(2, 0), -1.0, 1.0)), std::atan2(r(1, 0), r(0, 0))};
}

Vec3 alternative_euler_angles(const Vec3& a) {
  constexpr double half_turn = std::numbers::pi;
  return {wrap_to_pi(a.x() + half_turn), wrap_to_pi(half_turn - a.y()), wrap_to_pi(a.z() + half_turn)};
}

std::vector<JointSignal> find_joint_signals(const RecordedMotion& motion, std::size_t parent, std::size_t child,
                                            const JointSignalOptions& options) {
  const GaussianKernel kernel = gaussian_kernel(options.smoothing, motion.period);
  const SegmentMotion &p = motion.segments[parent], &c = motion.segments[child];
  std::vector<JointSignal> signals;
  if (options.terminals == JointVariableKind::euler)
    signals = euler_signals(p, c, kernel);
  else
    signals.push_back(relative_rotation_signal(p, c, kernel));
  double largest = 0.0;
  for (const JointSignal& signal : signals) largest = std::max(largest, standard_deviation(signal.angle));
  std::erase_if(signals, [&](const JointSignal& signal) {
    return standard_deviation(signal.angle) < std::max(options.min_excitation * largest, options.min_rotation);
  });
  return signals;
}

}  // namespace kinfer
