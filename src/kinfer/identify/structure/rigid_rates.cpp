// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/structure/rigid_rates.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "kinfer/linalg/decompositions.hpp"

namespace kinfer::identify {
namespace {

constexpr double mean_time = 0.1;  // [s]
constexpr Eigen::Index regressors = 7;

using Regressors = Eigen::Matrix<double, regressors, 1>;

/// Mean angular velocities, each in its sensor; windows with rows that are not usable are left out.
struct RateMeans {
  std::vector<Vec3> parent, child;
  std::vector<std::size_t> window;  // consecutive numbers are neighbours
};

RateMeans rate_means(const RecordedMotion& motion, const SegmentMotion& parent, const SegmentMotion& child) {
  RateMeans means;
  const auto rows = std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(mean_time / motion.period)));
  for (std::size_t window = 0; (window + 1) * rows <= motion.rows(); ++window) {
    Vec3 p = Vec3::Zero(), c = Vec3::Zero();
    bool is_usable = true;
    for (std::size_t row = window * rows; row < (window + 1) * rows; ++row) {
      is_usable = is_usable && motion.usable[row];
      p += parent.gyro[row] / static_cast<double>(rows);
      c += child.gyro[row] / static_cast<double>(rows);
    }
    if (!is_usable) continue;
    means.parent.push_back(p);
    means.child.push_back(c);
    means.window.push_back(window);
  }
  return means;
}

/// Whether the windows from i − before to i + behind are neighbours.
bool are_neighbours(const std::vector<std::size_t>& window, std::size_t i, std::size_t before, std::size_t behind) {
  return i >= before && i + behind < window.size() && window[i + behind] - window[i - before] == before + behind;
}

struct Residuals {
  std::vector<Vec3> value;
  std::vector<std::size_t> window;
};

Residuals residuals_of(const RateMeans& means) {
  std::vector<Regressors> x;
  std::vector<Vec3> y;
  Residuals result;
  Eigen::Matrix<double, regressors, regressors> normal = Eigen::Matrix<double, regressors, regressors>::Zero();
  Eigen::Matrix<double, regressors, 3> right = Eigen::Matrix<double, regressors, 3>::Zero();
  for (std::size_t i = 0; i < means.window.size(); ++i) {
    if (!are_neighbours(means.window, i, 1, 1)) continue;
    x.emplace_back();
    x.back() << means.parent[i], (means.parent[i + 1] - means.parent[i - 1]) / (2.0 * mean_time), 1.0;
    y.push_back(means.child[i]);
    result.window.push_back(means.window[i]);
    normal += x.back() * x.back().transpose();
    right += x.back() * y.back().transpose();
  }
  constexpr double least = 1e-9;  // of the largest: where the parent is at rest
  normal.diagonal().array() += least * std::max(normal.trace(), 1.0);
  for (std::size_t i = 0; i < x.size(); ++i) result.value.push_back(y[i]);
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    if (const auto solution = solve_spd(normal, right.col(axis)))
      for (std::size_t i = 0; i < x.size(); ++i) result.value[i][axis] -= solution->dot(x[i]);
  return result;
}

double noise_of(const Residuals& residuals, const Vec3& direction) {
  constexpr double white = 70.0;  // variance of the fourth difference of white noise: 1 + 16 + 36 + 16 + 1
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < residuals.window.size(); ++i) {
    if (!are_neighbours(residuals.window, i, 2, 2)) continue;
    const auto at = [&](std::size_t k) { return direction.dot(residuals.value[k]); };
    const double difference = at(i - 2) - 4.0 * at(i - 1) + 6.0 * at(i) - 4.0 * at(i + 1) + at(i + 2);
    sum += difference * difference / white, count += 1.0;
  }
  return count > 0.0 ? std::sqrt(sum / count) : 0.0;
}

double level_of(const std::vector<Vec3>& rates) {
  double sum = 0.0;
  for (const Vec3& rate : rates) sum += rate.squaredNorm();
  return rates.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(rates.size()));
}

}  // namespace

RigidRates rigid_rates(const RecordedMotion& motion, const SegmentMotion& parent, const SegmentMotion& child) {
  const RateMeans means = rate_means(motion, parent, child);
  const Residuals residuals = residuals_of(means);
  if (residuals.value.empty()) return {};
  Mat3 mean_square = Mat3::Zero();
  for (const Vec3& value : residuals.value)
    mean_square += value * value.transpose() / static_cast<double>(residuals.value.size());
  const SymmetricEigen principal = symmetric_eigen(mean_square);
  return {.residual = std::sqrt(std::max(0.0, principal.values[2])),
          .noise = noise_of(residuals, principal.vectors.col(2)),
          .level = std::max(level_of(means.parent), level_of(means.child))};
}

}  // namespace kinfer::identify
