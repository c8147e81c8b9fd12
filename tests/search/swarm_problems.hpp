// SPDX-License-Identifier: Apache-2.0
// Bounded problems with known minima, for the swarm searches.
#pragma once

#include <cmath>

#include "kinfer/search/swarm/objective.hpp"

namespace kinfer::testing {

inline Bounds cube(Eigen::Index dim, double half_width) {
  return {VectorXd::Constant(dim, -half_width), VectorXd::Constant(dim, half_width)};
}

template <class Cost>
Objective objective_of(const Bounds& bounds, Cost cost) {
  return {bounds, [cost](ConstMatrixRef x, std::span<double> values) {
            for (Eigen::Index i = 0; i < x.cols(); ++i) values[i] = cost(VectorXd(x.col(i)));
          }};
}

/// Σ (x_d − 0.3)², minimum at 0.3 in each dimension.
inline Objective shifted_sphere(Eigen::Index dim) {
  return objective_of(cube(dim, 1.0), [](const VectorXd& x) { return (x.array() - 0.3).square().sum(); });
}

/// Rastrigin: 10 local minima along each axis, the global one at 0.
inline Objective rastrigin(Eigen::Index dim) {
  return objective_of(cube(dim, 5.12), [](const VectorXd& x) {
    return (x.array().square() - 10.0 * (2.0 * M_PI * x.array()).cos() + 10.0).sum();
  });
}

}  // namespace kinfer::testing
