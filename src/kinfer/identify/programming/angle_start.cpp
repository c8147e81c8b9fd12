// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/programming/angle_start.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinfer/linalg/decompositions.hpp"

namespace kinfer::identify {
namespace {

/// Rotation of the leaves as constant + cos q · cosine + sin q · sine; the signal occurs once.
struct RotationInSignal {
  Mat3 constant = Mat3::Identity(), cosine = Mat3::Zero(), sine = Mat3::Zero();

  void rotate(const Mat3& r) { constant *= r, cosine *= r, sine *= r; }
  void rotate_by_signal(int axis) {  // R(q) = n nᵀ + cos q (1 − n nᵀ) + sin q [n]×
    const Vec3 n = axis == 0 ? Vec3::UnitX() : Vec3::UnitZ();
    const Mat3 before = constant;
    constant = before * (n * n.transpose());
    cosine = before - constant;
    sine = before * skew(n);
  }
};

/// Σ tr(R~ᵀ R): half the sum of the squared chords is 3 n minus this.
double agreement(const std::vector<DhLeaf>& leaves, const RotationMoments& moments) {
  RotationInSignal chain;
  for (const DhLeaf& leaf : leaves) {
    if (leaf.theta != 0.0) chain.rotate(rot_z(leaf.theta));
    if (leaf.theta_signal != DhLeaf::constant) chain.rotate_by_signal(2);
    if (leaf.alpha != 0.0) chain.rotate(rot_x(leaf.alpha));
    if (leaf.alpha_signal != DhLeaf::constant) chain.rotate_by_signal(0);
  }
  return moments[0].cwiseProduct(chain.constant).sum() + moments[1].cwiseProduct(chain.cosine).sum() +
         moments[2].cwiseProduct(chain.sine).sum();
}

/// Coordinate ascent: sets each angle in turn to the maximum of the agreement, a sinusoid in it.
double sweep_angles(std::vector<DhLeaf>& leaves, const std::vector<double*>& angles, const RotationMoments& moments) {
  double best = agreement(leaves, moments);
  for (double* angle : angles) {
    const auto at = [&](double value) { return *angle = value, agreement(leaves, moments); };
    const double zero = at(0.0), half = at(std::numbers::pi), quarter = at(0.5 * std::numbers::pi);
    best = at(std::atan2(quarter - 0.5 * (zero + half), 0.5 * (zero - half)));
  }
  return best;
}

/// A Newton step on the agreement in all angles, damped until the agreement increases.
double newton_step(std::vector<DhLeaf>& leaves, const std::vector<double*>& angles, const RotationMoments& moments,
                   double& damping, double best) {
  constexpr double h = 1e-4;  // [rad]
  const auto n = static_cast<Eigen::Index>(angles.size());
  const auto at = [&](Eigen::Index i, double di, Eigen::Index j, double dj) {
    double &a = *angles[static_cast<std::size_t>(i)], &b = *angles[static_cast<std::size_t>(j)];
    const double a_before = a, b_before = b;
    a += di;
    b += dj;
    const double value = agreement(leaves, moments);
    b = b_before;
    a = a_before;
    return value;
  };
  VectorXd gradient(n), up(n);
  MatrixXd curvature(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    up[i] = at(i, h, i, 0.0);
    const double down = at(i, -h, i, 0.0);
    gradient[i] = (up[i] - down) / (2.0 * h);
    curvature(i, i) = -(up[i] - 2.0 * best + down) / (h * h);
  }
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < i; ++j)
      curvature(i, j) = curvature(j, i) = -(at(i, h, j, h) - up[i] - up[j] + best) / (h * h);
  const std::vector<DhLeaf> before = leaves;
  const double size = std::max(1.0, curvature.diagonal().cwiseAbs().maxCoeff());
  for (int tries = 0; tries < 8; ++tries, damping = std::max(10.0 * damping, 1e-6)) {
    const auto change = solve_spd(curvature + damping * size * MatrixXd::Identity(n, n), gradient);
    if (!change) continue;
    for (Eigen::Index i = 0; i < n; ++i) *angles[static_cast<std::size_t>(i)] += (*change)[i];
    if (const double now = agreement(leaves, moments); now > best) return damping *= 0.03, now;
    for (std::size_t i = 0; i < leaves.size(); ++i)
      leaves[i].theta = before[i].theta, leaves[i].alpha = before[i].alpha;
  }
  return best;
}

}  // namespace

double maximise_agreement(std::vector<DhLeaf>& leaves, const std::vector<double*>& angles,
                          const RotationMoments& moments, double tolerance) {
  constexpr int sweeps = 4, most_newton_steps = 25;
  double best = agreement(leaves, moments), damping = 1e-6;
  for (int k = 0; k < sweeps && !angles.empty(); ++k) best = sweep_angles(leaves, angles, moments);
  for (int k = 0; k < most_newton_steps && !angles.empty(); ++k) {
    const double before = best;
    best = newton_step(leaves, angles, moments, damping, before);
    if (best - before < tolerance) break;
  }
  return best;
}

}  // namespace kinfer::identify
