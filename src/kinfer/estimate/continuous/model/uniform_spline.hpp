// SPDX-License-Identifier: Apache-2.0
// Uniform quintic B-splines: functions of time with continuous fourth derivative.
//
// On interval k, t = begin + (k + u) h, the value is Σ_i c_{k+i} b_i(u), i = 0..5; b by Cox and de Boor's recursion
// (de Boor 1978), so `intervals` intervals need intervals + 5 coefficients.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "kinfer/linalg/types.hpp"

namespace kinfer {

constexpr int spline_order = 6;        // coefficients with support in an interval
constexpr int spline_derivatives = 4;  // value and three derivatives

/// Values and derivatives of the six basis functions at one position in an interval.
struct SplineBasis {
  std::array<std::array<double, spline_order>, spline_derivatives> at{};  ///< [derivative][coefficient]
};

/// At u in 0..1 of an interval of length h; derivatives are with respect to time.
SplineBasis spline_basis(double u, double h);

/// The time axis of a spline.
struct SplineGrid {
  double begin = 0.0;   ///< [s]
  double period = 0.1;  ///< [s] between knots
  Eigen::Index intervals = 0;

  double end() const { return begin + period * static_cast<double>(intervals); }
  Eigen::Index coefficients() const { return intervals + spline_order - 1; }
  /// Interval of a time, clamped to the grid, and the position u in it.
  std::pair<Eigen::Index, double> locate(double time) const;
};

/// Least-squares fit of a spline to samples. `stiffness` weights the third difference of the coefficients, which
/// bridges gaps. `values`: samples x dimensions, NaN: missing; returns dimensions x coefficients.
MatrixXd fit_spline(const SplineGrid& grid, std::span<const double> time, ConstMatrixRef values,
                    double stiffness = 1e-6);

/// Derivative `order` of every dimension (row of `coefficients`) at a time.
VectorXd spline_value(const SplineGrid& grid, ConstMatrixRef coefficients, double time, int order = 0);

}  // namespace kinfer
