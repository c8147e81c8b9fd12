// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/model/uniform_spline.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/expect.hpp"
#include "kinfer/linalg/bordered_band.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;

/// Polynomial coefficients in u of the six basis functions on an interval, built up degree by degree: b_i of degree n
/// is
/// ((u + n − i) b_i^{n−1} + (1 + i − u) b_{i−1}^{n−1}) / n with pieces counted from the earliest coefficient.
std::array<std::array<double, spline_order>, spline_order> pieces() {
  std::array<std::array<double, spline_order>, spline_order> piece{};  // [coefficient][power of u]
  piece[0][0] = 1.0;
  for (int degree = 1; degree < spline_order; ++degree) {
    auto next = decltype(piece){};
    for (int i = 0; i <= degree; ++i)
      for (int power = 0; power < degree; ++power) {
        const auto p = static_cast<std::size_t>(power), c = static_cast<std::size_t>(i);
        const double scale = 1.0 / degree;
        if (i > 0) {  // rising: (u + degree − i) / degree of the previous piece
          next[c][p + 1] += scale * piece[c - 1][p];
          next[c][p] += scale * (degree - i) * piece[c - 1][p];
        }
        if (i < degree) {  // falling: (1 + i − u) / degree
          next[c][p] += scale * (1 + i) * piece[c][p];
          next[c][p + 1] -= scale * piece[c][p];
        }
      }
    piece = next;
  }
  return piece;
}

}  // namespace

SplineBasis spline_basis(double u, double h) {
  static const auto piece = pieces();
  SplineBasis basis;
  double scale = 1.0;
  for (int order = 0; order < spline_derivatives; ++order, scale /= h)
    for (std::size_t i = 0; i < spline_order; ++i) {
      double sum = 0.0;
      for (int power = spline_order - 1; power >= order; --power) {
        double factor = 1.0;
        for (int k = 0; k < order; ++k) factor *= power - k;
        sum = sum * u + factor * piece[i][static_cast<std::size_t>(power)];
      }
      basis.at[static_cast<std::size_t>(order)][i] = scale * sum;
    }
  return basis;
}

std::pair<Index, double> SplineGrid::locate(double time) const {
  const double where = (time - begin) / period;
  const auto k = std::clamp<Index>(static_cast<Index>(std::floor(where)), 0, intervals - 1);
  return {k, std::clamp(where - static_cast<double>(k), 0.0, 1.0)};
}

MatrixXd fit_spline(const SplineGrid& grid, std::span<const double> time, ConstMatrixRef values, double stiffness) {
  KINFER_EXPECT(values.rows() == static_cast<Index>(time.size()));
  // All dimensions share the band matrix; their right-hand sides are passed as border columns.
  const Index spline_dimensions = values.cols();
  BorderedBand band(1, spline_order, spline_dimensions);
  MatrixXd squares = 1e-12 * MatrixXd::Identity(spline_dimensions, spline_dimensions);
  std::size_t row = 0;
  Eigen::Matrix<double, spline_order, 1> third;
  third << -1.0, 3.0, -3.0, 1.0, 0.0, 0.0;
  for (Index k = 0; k < grid.intervals; ++k) {
    BandSpan span{stiffness * third * third.transpose(), MatrixXd::Zero(spline_dimensions, spline_order),
                  VectorXd::Zero(spline_order)};
    if (k + 1 == grid.intervals)
      for (Index shift = 1; shift <= 2; ++shift) {
        Eigen::Matrix<double, spline_order, 1> late = Eigen::Matrix<double, spline_order, 1>::Zero();
        late.segment<4>(shift) = third.head<4>();
        span.matrix += stiffness * late * late.transpose();
      }
    span.matrix.diagonal().array() += 1e-9 * stiffness;
    for (; row < time.size() && (k + 1 == grid.intervals || grid.locate(time[row]).first <= k); ++row) {
      const auto basis = spline_basis(grid.locate(time[row]).second, 1.0);
      const Eigen::Map<const Eigen::Matrix<double, spline_order, 1>> b(basis.at[0].data());
      const VectorXd value = values.row(static_cast<Index>(row)).transpose();
      if (!value.allFinite()) continue;
      span.matrix += b * b.transpose();
      span.coupling += value * b.transpose();
      squares += value * value.transpose();
    }
    band.add(span);
  }
  band.finish(squares, VectorXd::Zero(spline_dimensions));
  KINFER_EXPECT(band.is_positive_definite());
  return band.sensitivity().transpose();
}

VectorXd spline_value(const SplineGrid& grid, ConstMatrixRef coefficients, double time, int order) {
  const auto [k, u] = grid.locate(time);
  const SplineBasis basis = spline_basis(u, grid.period);
  const Eigen::Map<const Eigen::Matrix<double, spline_order, 1>> b(basis.at[static_cast<std::size_t>(order)].data());
  return coefficients.middleCols(k, spline_order) * b;
}

}  // namespace kinfer
