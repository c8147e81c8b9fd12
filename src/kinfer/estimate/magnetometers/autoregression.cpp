// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/magnetometers/autoregression.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/geometry/statistics.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer {
namespace {

using Lags = Eigen::Matrix<double, autoregressive_order, 1>;

constexpr double tail_freedom =
    4.0;                          // degrees of freedom of Student's t: a sample at five sigma has a fifth of the weight
constexpr int weight_rounds = 8;  // of weights and coefficients in turn
constexpr double longest_memory = 0.995;  // bound on Σφ: the level of a series always tells something
constexpr double shrinkage = 1e-3;        // ridge, relative to the residuals' mean square

/// Times whose own and preceding values are all there.
std::vector<bool> complete_times(const std::vector<bool>& is_valid) {
  std::vector<bool> result(is_valid.size(), false);
  std::size_t run = 0;
  for (std::size_t t = 0; t < is_valid.size(); ++t) {
    run = is_valid[t] ? run + 1 : 0;
    result[t] = run > autoregressive_order;
  }
  return result;
}

void estimate_coefficients(AutoregressiveNoise& noise, const std::vector<Vec3>& residual) {
  Eigen::Matrix<double, autoregressive_order, autoregressive_order> matrix;
  matrix.setZero();
  Lags right = Lags::Zero();
  for (std::size_t t = autoregressive_order; t < residual.size(); ++t) {
    if (!(noise.weight[t] > 0.0)) continue;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      Lags before;
      for (std::size_t j = 0; j < autoregressive_order; ++j)
        before[static_cast<Eigen::Index>(j)] = residual[t - j - 1][axis];
      matrix += noise.weight[t] * before * before.transpose();
      right += noise.weight[t] * residual[t][axis] * before;
    }
  }
  matrix.diagonal().array() += shrinkage * matrix.diagonal().mean() + 1e-30;
  const auto solution = solve_spd(matrix, right);
  if (!solution) return;
  const double sum = solution->sum(), scale = sum > longest_memory ? longest_memory / sum : 1.0;
  for (std::size_t j = 0; j < autoregressive_order; ++j)
    noise.coefficients[j] = scale * (*solution)[static_cast<Eigen::Index>(j)];
}

/// One step of expectation maximisation for the scale and weights of Student's t.
void estimate_weights(AutoregressiveNoise& noise, const std::vector<Vec3>& residual,
                      const std::vector<bool>& is_complete) {
  double sum = 0.0, count = 0.0;
  for (std::size_t t = autoregressive_order; t < residual.size(); ++t) {
    if (!is_complete[t]) continue;
    const double square = innovation(noise, t, [&](std::size_t at) { return residual[at]; }).squaredNorm();
    noise.weight[t] = (tail_freedom + 3.0) / (tail_freedom + square / (noise.sd * noise.sd));
    sum += noise.weight[t] * square;
    count += 3.0;
  }
  if (count > 0.0 && sum > 0.0) noise.sd = std::sqrt(sum / count);
}

/// Information of an M-estimator, (Σψ')² / Σψ² (Huber 1981, 3.2), over that of its weights: with heavy tails the
/// weights alone would count outliers that they have removed.
double efficiency_of(const AutoregressiveNoise& noise, const std::vector<Vec3>& residual,
                     const std::vector<bool>& is_complete) {
  double slope = 0.0, square_sum = 0.0, weights = 0.0, count = 0.0;
  for (std::size_t t = autoregressive_order; t < residual.size(); ++t) {
    if (!is_complete[t]) continue;
    const double w = noise.weight[t],
                 square = innovation(noise, t, [&](std::size_t at) { return residual[at]; }).squaredNorm() /
                          (noise.sd * noise.sd);
    slope += w - 2.0 / 3.0 * w * w * square / (tail_freedom + 3.0);
    square_sum += w * w * square / 3.0;
    weights += w;
    count += 1.0;
  }
  return count > 0.0 && square_sum > 0.0 ? slope * slope / (square_sum * weights) : 1.0;
}

/// Scale of the innovations that outliers do not move.
double innovation_scale(const std::vector<Vec3>& residual, const std::vector<bool>& is_complete) {
  std::vector<double> values;
  for (std::size_t t = 0; t < residual.size(); ++t)
    if (is_complete[t])
      for (const double value : residual[t]) values.push_back(std::abs(value));
  return values.empty() ? 1.0 : std::max(1e-9, 1.4826 * median(values));
}

}  // namespace

AutoregressiveNoise estimate_noise(const std::vector<Vec3>& residual, const std::vector<bool>& is_valid) {
  const std::vector<bool> is_complete = complete_times(is_valid);
  AutoregressiveNoise noise{.sd = innovation_scale(residual, is_complete),
                            .weight = std::vector<double>(residual.size(), 0.0)};
  for (int round = 0; round < weight_rounds; ++round) {
    estimate_weights(noise, residual, is_complete);
    estimate_coefficients(noise, residual);
  }
  estimate_weights(noise, residual, is_complete);
  noise.efficiency = efficiency_of(noise, residual, is_complete);
  return noise;
}

}  // namespace kinfer
