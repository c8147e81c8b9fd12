// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/geometry/joint_precision.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/angle.hpp"
#include "kinfer/identify/geometry/thresholds.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/linalg/products.hpp"

namespace kinfer::identify {
namespace {

constexpr double prior_sd = 100.0;  // [m] or [rad] sd of the prior that keeps unobservable parameters finite

/// The ten parameters as small motions of a frame with z along the axis (0-2: rotations about x y z, 3-5:
/// translations), on the parent's and on the child's side.
constexpr std::array<int, 4> parent_motions{0, 1, 3, 4};
constexpr std::array<int, 6> child_motions{0, 1, 3, 4, 2, 5};

using PoseIncrement = Eigen::Matrix<double, 6, 1>;
using RevoluteStep = Eigen::Matrix<double, 10, 1>;
using FrameResidual = Eigen::Matrix<double, 6, 1>;  // acceleration [m/s²], small rotation [rad], in the world frame

Pose small_motion(const PoseIncrement& change) {
  return {exp_so3(Vec3(change.head<3>())), change.tail<3>()};
}

/// The revolute joint as parent_T_axis, a rotation about z, axis_T_child.
struct SplitRevolute {
  Pose before, after;
};

SplitRevolute split_at_axis(const JointGeometry& revolute) {
  Mat3 axes;
  axes.col(2) = revolute.axis_in_parent;
  axes.col(0) = any_perpendicular(revolute.axis_in_parent);
  axes.col(1) = axes.col(2).cross(axes.col(0));
  const Pose before{axes, revolute.point_in_parent};
  return {before, before.inverse() * revolute.home};
}

SplitRevolute perturbed(const SplitRevolute& revolute, const RevoluteStep& numbers) {
  PoseIncrement of_parent = PoseIncrement::Zero(), of_child = PoseIncrement::Zero();
  for (std::size_t k = 0; k < parent_motions.size(); ++k)
    of_parent[parent_motions[k]] = numbers[static_cast<Eigen::Index>(k)];
  for (std::size_t k = 0; k < child_motions.size(); ++k)
    of_child[child_motions[k]] = numbers[static_cast<Eigen::Index>(4 + k)];
  return {revolute.before * small_motion(of_parent), small_motion(of_child) * revolute.after};
}

FrameState propagate_by(FrameState state, const Pose& pose) {
  const Vec3 arm = state.rotation * pose.position;
  state.acceleration +=
      state.angular_acceleration.cross(arm) + state.angular_velocity.cross(state.angular_velocity.cross(arm));
  state.rotation = state.rotation * pose.rotation;
  return state;
}

FrameState predict(const SplitRevolute& revolute, const FrameState& parent, const SignalRow& angle) {
  const DhLeaf turn{.theta_signal = 0};
  return propagate_by(propagate(propagate_by(parent, revolute.before), std::span<const DhLeaf>(&turn, 1), angle),
                      revolute.after);
}

FrameResidual residual_of(const FrameState& a, const FrameState& b) {
  FrameResidual result;
  result << a.acceleration - b.acceleration, log_so3(a.rotation * b.rotation.transpose());
  return result;
}

/// Mean square of the residuals of one kind, inflated for their autocorrelation by (1 + r) / (1 − r), r being the
/// correlation of successive rows.
double inflated_variance(const std::vector<FrameResidual>& residuals, Eigen::Index first) {
  double square = 0.0, product = 0.0;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    square += residuals[i].segment<3>(first).squaredNorm();
    if (i > 0) product += residuals[i].segment<3>(first).dot(residuals[i - 1].segment<3>(first));
  }
  const double r = square > 0.0 ? std::clamp(product / square, 0.0, 0.99) : 0.0;
  return std::max(square / (3.0 * static_cast<double>(residuals.size())), 1e-18) * (1.0 + r) / (1.0 - r);
}

/// Directions in the sensor frame along which a lever arm changes the acceleration by less than the noise.
std::vector<Vec3> unobservable_levers(const std::vector<FrameState>& states, const std::vector<std::size_t>& rows,
                                      double variance) {
  Mat3 gram = Mat3::Zero();
  for (const std::size_t row : rows) {
    const Mat3 angular_velocity = skew(states[row].angular_velocity);
    const Mat3 effect =
        (skew(states[row].angular_acceleration) + angular_velocity * angular_velocity) * states[row].rotation;
    gram += effect.transpose() * effect;
  }
  const SymmetricEigen eigen = symmetric_eigen(gram);
  std::vector<Vec3> hidden;
  for (Eigen::Index k = 0; k < 3; ++k)
    if (eigen.values[k] * max_lever_sd * max_lever_sd < variance) hidden.push_back(eigen.vectors.col(k));
  return hidden;
}

JointGeometry geometry_of(const SplitRevolute& revolute) {
  const Pose child_T_axis = revolute.after.inverse();
  JointGeometry geometry;
  geometry.home = revolute.before * revolute.after;
  geometry.axis_in_parent = revolute.before.rotation.col(2);
  geometry.axis_in_child = child_T_axis.rotation.col(2);
  const double along = geometry.axis_in_child.dot(child_T_axis.position);
  geometry.point_in_child = child_T_axis.position - along * geometry.axis_in_child;
  geometry.point_in_parent = revolute.before.position - along * geometry.axis_in_parent;
  return geometry;
}

/// Standard deviations of the canonical DH parameters from the covariance of the ten, by finite differences.
std::array<DhNumbers, 3> canonical_row_sd(const SplitRevolute& base, const MatrixXd& covariance, double step) {
  constexpr std::array<double DhNumbers::*, 5> numbers{&DhNumbers::theta, &DhNumbers::d, &DhNumbers::alpha,
                                                       &DhNumbers::a, &DhNumbers::beta};
  const auto here = canonical_dh_rows(geometry_of(base));
  MatrixXd derivative(15, 10);
  for (Eigen::Index k = 0; k < 10; ++k) {
    const auto there = canonical_dh_rows(geometry_of(perturbed(base, step * RevoluteStep::Unit(k))));
    for (std::size_t i = 0; i < 15; ++i)
      derivative(static_cast<Eigen::Index>(i), k) =
          wrap_to_pi(there[i / 5].*numbers[i % 5] - here[i / 5].*numbers[i % 5]) / step;
  }
  const VectorXd variance = propagated_covariance(derivative, covariance).diagonal();
  std::array<DhNumbers, 3> sd;
  for (std::size_t i = 0; i < 15; ++i)
    sd[i / 5].*numbers[i % 5] = std::sqrt(std::max(0.0, variance[static_cast<Eigen::Index>(i)]));
  return sd;
}

}  // namespace

JointPrecision revolute_precision(const JointGeometry& revolute, const std::vector<FrameState>& parent,
                                  const std::vector<FrameState>& child, const JointSignal& angle,
                                  const std::vector<std::size_t>& rows) {
  constexpr double step = 1e-6;  // [rad], [m]
  const SplitRevolute base = split_at_axis(revolute);
  std::vector<FrameResidual> residuals;
  for (const std::size_t row : rows)
    residuals.push_back(residual_of(predict(base, parent[row], signals_at({&angle, 1}, row)), child[row]));
  const double acceleration = inflated_variance(residuals, 0), turn = inflated_variance(residuals, 3);
  FrameResidual weight;
  weight << Vec3::Constant(1.0 / acceleration), Vec3::Constant(1.0 / turn);
  MatrixXd information = MatrixXd::Identity(10, 10) / (prior_sd * prior_sd);
  for (const std::size_t row : rows) {
    const SignalRow at = signals_at({&angle, 1}, row);
    const FrameState here = predict(base, parent[row], at);
    Eigen::Matrix<double, 6, 10> jacobian;
    for (Eigen::Index k = 0; k < 10; ++k)
      jacobian.col(k) =
          residual_of(predict(perturbed(base, step * RevoluteStep::Unit(k)), parent[row], at), here) / step;
    information += jacobian.transpose() * weight.asDiagonal() * jacobian;
  }
  JointPrecision result;
  const auto inverse = invert_spd(information);
  const MatrixXd covariance = inverse ? *inverse : MatrixXd(prior_sd * prior_sd * MatrixXd::Identity(10, 10));
  const auto sd = [&](Eigen::Index k) { return std::sqrt(covariance(k, k)); };
  result.sd = {.axis_in_parent = {sd(0), sd(1)},
               .axis_in_child = {sd(4), sd(5)},
               .point_in_parent = {sd(2), sd(3)},
               .point_in_child = {sd(6), sd(7)},
               .along_axis = sd(9)};
  const auto canonical_sd = canonical_row_sd(base, covariance, step);
  result.canonical_sd.assign(canonical_sd.begin(), canonical_sd.end());
  result.unobservable_in_parent = unobservable_levers(parent, rows, acceleration);
  result.unobservable_in_child = unobservable_levers(child, rows, acceleration);
  return result;
}

}  // namespace kinfer::identify
