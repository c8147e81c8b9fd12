#include "kinfer/identify/hinge_precision.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/linalg/decompositions.hpp"

namespace kinfer {
namespace {

constexpr double unknown_length = 0.5;  // [m] standard deviation from which on a lever direction counts as not known
constexpr double widest = 100.0;        // [m] or [rad] prior that keeps what no signal sees finite

/// Which of a frame's six small motions (turns x y z, shifts x y z) each of the ten numbers is, beside the parent's
/// sensor and beside the child's: frames with z along the axis.
constexpr std::array<int, 4> parent_motions{0, 1, 3, 4};
constexpr std::array<int, 6> child_motions{0, 1, 3, 4, 2, 5};

using Change = Eigen::Matrix<double, 6, 1>;
using Numbers = Eigen::Matrix<double, 10, 1>;
using Prediction = Eigen::Matrix<double, 6, 1>;  // acceleration [m/s²] and small turn [rad], in the ground

Pose small_motion(const Change& change) {
  return {exp_so3(Vec3(change.head<3>())), change.tail<3>()};
}

/// The hinge as parent_T_axis, a turn about z, axis_T_child.
struct SplitHinge {
  Pose before, after;
};

SplitHinge split(const HingeGeometry& hinge) {
  Mat3 axes;
  axes.col(2) = hinge.axis_in_parent;
  axes.col(0) = any_perpendicular(hinge.axis_in_parent);
  axes.col(1) = axes.col(2).cross(axes.col(0));
  const Pose before{axes, hinge.point_in_parent};
  return {before, before.inverse() * hinge.home};
}

SplitHinge changed(const SplitHinge& hinge, const Numbers& numbers) {
  Change of_parent = Change::Zero(), of_child = Change::Zero();
  for (std::size_t k = 0; k < parent_motions.size(); ++k)
    of_parent[parent_motions[k]] = numbers[static_cast<Eigen::Index>(k)];
  for (std::size_t k = 0; k < child_motions.size(); ++k)
    of_child[child_motions[k]] = numbers[static_cast<Eigen::Index>(4 + k)];
  return {hinge.before * small_motion(of_parent), small_motion(of_child) * hinge.after};
}

FrameState carried_by(FrameState state, const Pose& pose) {
  const Vec3 arm = state.rotation * pose.position;
  state.acceleration += state.rate_change.cross(arm) + state.rate.cross(state.rate.cross(arm));
  state.rotation = state.rotation * pose.rotation;
  return state;
}

FrameState predicted(const SplitHinge& hinge, const FrameState& parent, const SignalRow& angle) {
  const DhLeaf turn{.theta_signal = 0};
  return carried_by(carried(carried_by(parent, hinge.before), std::span<const DhLeaf>(&turn, 1), angle), hinge.after);
}

Prediction difference(const FrameState& a, const FrameState& b) {
  Prediction result;
  result << a.acceleration - b.acceleration, log_so3(a.rotation * b.rotation.transpose());
  return result;
}

/// Mean square of the residuals of one kind and how much fewer independent ones there are, (1 + r) / (1 − r) with the
/// correlation r of neighbours.
double inflated_variance(const std::vector<Prediction>& residuals, Eigen::Index first) {
  double square = 0.0, product = 0.0;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    square += residuals[i].segment<3>(first).squaredNorm();
    if (i > 0) product += residuals[i].segment<3>(first).dot(residuals[i - 1].segment<3>(first));
  }
  const double r = square > 0.0 ? std::clamp(product / square, 0.0, 0.99) : 0.0;
  return std::max(square / (3.0 * static_cast<double>(residuals.size())), 1e-18) * (1.0 + r) / (1.0 - r);
}

/// Directions in the sensor along which a lever arm changes its acceleration by so little that the noise hides it.
std::vector<Vec3> hidden_directions(const std::vector<FrameState>& states, const std::vector<std::size_t>& rows,
                                    double variance) {
  Mat3 gram = Mat3::Zero();
  for (const std::size_t row : rows) {
    const Mat3 rate = skew(states[row].rate);
    const Mat3 effect = (skew(states[row].rate_change) + rate * rate) * states[row].rotation;
    gram += effect.transpose() * effect;
  }
  const SymmetricEigen eigen = symmetric_eigen(gram);
  std::vector<Vec3> hidden;
  for (Eigen::Index k = 0; k < 3; ++k)
    if (eigen.values[k] * unknown_length * unknown_length < variance) hidden.push_back(eigen.vectors.col(k));
  return hidden;
}

HingeGeometry geometry_of(const SplitHinge& hinge) {
  const Pose child_T_axis = hinge.after.inverse();
  HingeGeometry geometry;
  geometry.home = hinge.before * hinge.after;
  geometry.axis_in_parent = hinge.before.rotation.col(2);
  geometry.axis_in_child = child_T_axis.rotation.col(2);
  const double along = geometry.axis_in_child.dot(child_T_axis.position);
  geometry.point_in_child = child_T_axis.position - along * geometry.axis_in_child;
  geometry.point_in_parent = hinge.before.position - along * geometry.axis_in_parent;
  return geometry;
}

/// Standard deviations of the canonical numbers from the covariance of the ten, by differences.
std::array<DhNumbers, 3> canonical_deviations(const SplitHinge& base, const MatrixXd& covariance, double step) {
  constexpr std::array<double DhNumbers::*, 5> numbers{&DhNumbers::theta, &DhNumbers::d, &DhNumbers::alpha,
                                                       &DhNumbers::a, &DhNumbers::beta};
  const auto here = canonical_rows(geometry_of(base));
  MatrixXd derivative(15, 10);
  for (Eigen::Index k = 0; k < 10; ++k) {
    const auto there = canonical_rows(geometry_of(changed(base, step * Numbers::Unit(k))));
    for (std::size_t i = 0; i < 15; ++i)
      derivative(static_cast<Eigen::Index>(i), k) =
          wrapped(there[i / 5].*numbers[i % 5] - here[i / 5].*numbers[i % 5]) / step;
  }
  const VectorXd variance = (derivative * covariance * derivative.transpose()).diagonal();
  std::array<DhNumbers, 3> sd;
  for (std::size_t i = 0; i < 15; ++i)
    sd[i / 5].*numbers[i % 5] = std::sqrt(std::max(0.0, variance[static_cast<Eigen::Index>(i)]));
  return sd;
}

}  // namespace

HingePrecision hinge_precision(const HingeGeometry& hinge, const std::vector<FrameState>& parent,
                               const std::vector<FrameState>& child, const JointSignal& angle,
                               const std::vector<std::size_t>& rows) {
  constexpr double step = 1e-6;  // [rad], [m]
  const SplitHinge base = split(hinge);
  std::vector<Prediction> residuals;
  for (const std::size_t row : rows)
    residuals.push_back(difference(predicted(base, parent[row], signals_at({&angle, 1}, row)), child[row]));
  const double acceleration = inflated_variance(residuals, 0), turn = inflated_variance(residuals, 3);
  Prediction weight;
  weight << Vec3::Constant(1.0 / acceleration), Vec3::Constant(1.0 / turn);
  MatrixXd information = MatrixXd::Identity(10, 10) / (widest * widest);
  for (const std::size_t row : rows) {
    const SignalRow at = signals_at({&angle, 1}, row);
    const FrameState here = predicted(base, parent[row], at);
    Eigen::Matrix<double, 6, 10> jacobian;
    for (Eigen::Index k = 0; k < 10; ++k)
      jacobian.col(k) = difference(predicted(changed(base, step * Numbers::Unit(k)), parent[row], at), here) / step;
    information += jacobian.transpose() * weight.asDiagonal() * jacobian;
  }
  HingePrecision result;
  const auto inverse = inverse_positive(information);
  const MatrixXd covariance = inverse ? *inverse : MatrixXd(widest * widest * MatrixXd::Identity(10, 10));
  const auto sd = [&](Eigen::Index k) { return std::sqrt(covariance(k, k)); };
  result.sd = {.axis_in_parent = {sd(0), sd(1)},
               .axis_in_child = {sd(4), sd(5)},
               .point_in_parent = {sd(2), sd(3)},
               .point_in_child = {sd(6), sd(7)},
               .slide = sd(9)};
  const auto canonical_sd = canonical_deviations(base, covariance, step);
  result.canonical_sd.assign(canonical_sd.begin(), canonical_sd.end());
  result.hidden_in_parent = hidden_directions(parent, rows, acceleration);
  result.hidden_in_child = hidden_directions(child, rows, acceleration);
  return result;
}

}  // namespace kinfer
