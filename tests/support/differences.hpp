// SPDX-License-Identifier: Apache-2.0
// Central differences: the independent reference of every analytic derivative.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace kinfer::testing {

/// d f / d x, one column per unknown, by central differences with steps of `step` times max(|x_j|, 1). The error is
/// about f''' h²/6 + 1e-16 |f| / h: 1e-6 and above suits functions of order one.
template <class Function>
Eigen::MatrixXd numeric_jacobian(const Function& f, const Eigen::VectorXd& x, double step = 1e-6) {
  Eigen::MatrixXd jacobian;
  for (Eigen::Index j = 0; j < x.size(); ++j) {
    const double h = step * std::max(std::abs(x[j]), 1.0);
    Eigen::VectorXd above = x, below = x;
    above[j] += h;
    below[j] -= h;
    const Eigen::VectorXd difference = Eigen::VectorXd(f(above)) - Eigen::VectorXd(f(below));
    if (jacobian.size() == 0) jacobian.resize(difference.size(), x.size());
    jacobian.col(j) = difference / (above[j] - below[j]);
  }
  return jacobian;
}

/// The analytic Jacobian of residuals beside the numeric one.
struct JacobianPair {
  Eigen::MatrixXd analytic, numeric;
};
template <class Residuals>
JacobianPair jacobians(const Residuals& problem, const Eigen::VectorXd& x) {
  Eigen::VectorXd r(problem.rows);
  JacobianPair pair{Eigen::MatrixXd(problem.rows, problem.unknowns), {}};
  problem.evaluate(x, r, &pair.analytic);
  pair.numeric = numeric_jacobian(
      [&](const Eigen::VectorXd& at) {
        Eigen::VectorXd out(problem.rows);
        problem.evaluate(at, out, nullptr);
        return out;
      },
      x, 1e-6);
  return pair;
}

}  // namespace kinfer::testing
