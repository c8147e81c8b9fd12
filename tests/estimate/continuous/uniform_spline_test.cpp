// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/model/uniform_spline.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace kinfer {
namespace {

double quintic(double t, int order) {
  const double c[]{0.3, -1.0, 2.0, 0.5, -0.7, 0.2};
  double sum = 0.0;
  for (int p = order; p < 6; ++p) {
    double factor = c[p];
    for (int k = 0; k < order; ++k) factor *= p - k;
    sum += factor * std::pow(t, p - order);
  }
  return sum;
}

TEST(UniformSpline, HoldsAQuinticAndItsDerivativesExactly) {
  const SplineGrid grid{-0.3, 0.2, 12};
  std::vector<double> time;
  for (double t = grid.begin; t < grid.end(); t += 0.01) time.push_back(t);
  MatrixXd values(static_cast<Eigen::Index>(time.size()), 2);
  for (std::size_t i = 0; i < time.size(); ++i)
    values.row(static_cast<Eigen::Index>(i)) << quintic(time[i], 0), -2.0 * quintic(time[i], 0);
  const MatrixXd coefficients = fit_spline(grid, time, values, 1e-14);
  ASSERT_EQ(coefficients.cols(), grid.coefficients());
  for (const double t : {-0.29, 0.0, 0.77, 1.5, 2.05})
    for (int order = 0; order < spline_derivatives; ++order) {
      const VectorXd is = spline_value(grid, coefficients, t, order);
      EXPECT_NEAR(is[0], quintic(t, order), 2e-5) << t << " " << order;
      EXPECT_NEAR(is[1], -2.0 * quintic(t, order), 4e-5);
    }
}

TEST(UniformSpline, BasisSumsToOneAndItsDerivativesToZero) {
  for (const double u : {0.0, 0.3, 1.0}) {
    const SplineBasis basis = spline_basis(u, 0.1);
    for (std::size_t order = 0; order < spline_derivatives; ++order) {
      double sum = 0.0, size = 0.0;
      for (const double b : basis.at[order]) sum += b, size += std::abs(b);
      EXPECT_NEAR(sum, order == 0 ? 1.0 : 0.0, 1e-13 * size);
    }
  }
}

TEST(UniformSpline, BridgesASpanWithoutSamples) {
  const SplineGrid grid{0.0, 0.1, 60};
  std::vector<double> time;
  for (double t = 0.0; t < 6.0; t += 0.01)
    if (t < 2.0 || t > 3.0) time.push_back(t);
  MatrixXd values(static_cast<Eigen::Index>(time.size()), 1);
  for (std::size_t i = 0; i < time.size(); ++i) values(static_cast<Eigen::Index>(i), 0) = std::sin(time[i]);
  EXPECT_NEAR(spline_value(grid, fit_spline(grid, time, values), 2.5)[0], std::sin(2.5), 0.02);
}

}  // namespace
}  // namespace kinfer
