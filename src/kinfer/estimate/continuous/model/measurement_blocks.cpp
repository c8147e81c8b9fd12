// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/model/measurement_blocks.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "kinfer/geometry/statistics.hpp"

namespace kinfer {
namespace {

using Row = Eigen::Matrix<double, 1, block_nodes>;
using Index = Eigen::Index;

std::optional<Vec3> measured_vector(const InsSample& s, InsInstrument instrument) {
  if (instrument == InsInstrument::accelerometer)
    return s.has_acceleration ? std::optional<Vec3>(s.acceleration) : std::nullopt;
  return s.has_angular_velocity && !s.angular_velocity_clipped ? std::optional<Vec3>(s.angular_velocity) : std::nullopt;
}

/// A block while its measurements are accumulated, in double precision.
struct OpenBlock {
  Eigen::Matrix<double, block_nodes, block_nodes> factor = Eigen::Matrix<double, block_nodes, block_nodes>::Zero();
  Eigen::Matrix<double, block_nodes, 3> target = Eigen::Matrix<double, block_nodes, 3>::Zero();
  Vec3 left = Vec3::Zero();
  int samples = 0;
};

InsBlock to_block(const OpenBlock& g) {
  return {g.factor.cast<float>(), g.target.cast<float>(), g.left.cast<float>(), g.samples,
          std::min(g.samples, block_nodes)};
}

/// Adds one row of V and y to R and Qᵀ y by Givens rotations; the remainder of y goes to the residual squares.
void take(OpenBlock& block, Row v, Vec3 y) {
  ++block.samples;
  for (Index k = 0; k < block_nodes; ++k) {
    const double r = std::hypot(block.factor(k, k), v[k]);
    if (r <= 0.0) continue;
    const double c = block.factor(k, k) / r, s = v[k] / r;
    const Row above = block.factor.row(k);
    const Vec3 target = block.target.row(k).transpose();
    block.factor.row(k) = c * above + s * v;
    block.target.row(k) = (c * target + s * y).transpose();
    v = (c * v - s * above).eval();
    y = (c * y - s * target).eval();
    block.factor.row(k).head(k).setZero();
  }
  block.left += y.cwiseAbs2();
}

}  // namespace

const std::array<double, block_nodes>& block_nodes_u() {
  // Roots of the Legendre polynomial of degree 4, mapped from −1..1 to 0..1 (Abramowitz and Stegun, table 25.4).
  static const std::array<double, block_nodes> places = [] {
    const double inner = std::sqrt(3.0 / 7.0 - 2.0 / 7.0 * std::sqrt(1.2)),
                 outer = std::sqrt(3.0 / 7.0 + 2.0 / 7.0 * std::sqrt(1.2));
    return std::array{0.5 - 0.5 * outer, 0.5 - 0.5 * inner, 0.5 + 0.5 * inner, 0.5 + 0.5 * outer};
  }();
  return places;
}

Row node_weights(double u) {
  const auto& x = block_nodes_u();
  Row row;
  for (std::size_t i = 0; i < block_nodes; ++i) {
    double product = 1.0;
    for (std::size_t j = 0; j < block_nodes; ++j)
      if (j != i) product *= (u - x[j]) / (x[i] - x[j]);
    row[static_cast<Index>(i)] = product;
  }
  return row;
}

const NodeMatrix& node_derivative() {
  static const NodeMatrix derivative = [] {
    NodeMatrix d = NodeMatrix::Zero();
    const auto& x = block_nodes_u();
    for (std::size_t i = 0; i < block_nodes; ++i)
      for (std::size_t j = 0; j < block_nodes; ++j)
        for (std::size_t left_out = 0; left_out < block_nodes; ++left_out) {
          if (left_out == j) continue;
          double product = 1.0 / (x[j] - x[left_out]);
          for (std::size_t m = 0; m < block_nodes; ++m)
            if (m != j && m != left_out) product *= (x[i] - x[m]) / (x[j] - x[m]);
          d(static_cast<Index>(i), static_cast<Index>(j)) += product;
        }
    return d;
  }();
  return derivative;
}

std::vector<InsBlock> ins_blocks(const InsSensor& sensor, std::span<const double> time, InsInstrument instrument,
                                 const SplineGrid& grid, double clock_offset) {
  std::vector<InsBlock> blocks(static_cast<std::size_t>(grid.intervals));
  OpenBlock open;
  Index at = -1;
  const auto close = [&] {
    if (open.samples > 0) blocks[static_cast<std::size_t>(at)] = to_block(open);
    open = {};
  };
  for (std::size_t row = 0; row < time.size(); ++row) {
    const double where = (time[row] + clock_offset - grid.begin) / grid.period;
    const auto k = static_cast<Index>(std::floor(where));
    if (k < 0 || k >= grid.intervals) continue;
    if (k != at) close();
    at = k;
    if (const auto value = measured_vector(sample(sensor, time, row), instrument))
      take(open, node_weights(where - static_cast<double>(k)), *value);
  }
  close();
  return blocks;
}

double measurement_noise(std::span<const InsBlock> blocks) {
  std::vector<double> variances;
  double freedom = 0.0;
  for (const InsBlock& block : blocks)
    if (block.samples >= block_nodes + 2) {
      const double n = 3.0 * (block.samples - block_nodes);
      variances.push_back(static_cast<double>(block.left.sum()) / n);
      freedom += n;
    }
  if (variances.empty()) return 0.0;
  const double typical = freedom / static_cast<double>(variances.size());
  const double bias = std::pow(1.0 - 2.0 / (9.0 * typical), 3.0);  // median over mean of chi-squared (Wilson, Hilferty)
  return std::sqrt(median(variances) / bias);
}

}  // namespace kinfer
