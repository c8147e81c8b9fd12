// SPDX-License-Identifier: Apache-2.0
// Prior on the spline coefficients: each spline dimension is smooth (far weaker than any real shaking), and an
// unobservable constant stays at its initial value. Of a slide that is only seen to accelerate, the velocity is
// unobservable, too: its travel is that of a machine.
#pragma once

#include <functional>

#include "kinfer/estimate/continuous/model/problem.hpp"

namespace kinfer {

/// One residual of the prior: Σ weights · (coefficients of the spline dimension in the interval) − expected value.
struct SplinePriorTerm {
  Eigen::Index spline_dimension;
  Eigen::Matrix<double, spline_order, 1> weights;
  double value, sd;
};

/// Calls visit(term) for each prior residual that belongs to the interval.
void each_spline_prior(const InsProblem& problem, const InsLayout& layout, ConstMatrixRef coefficients,
                       Eigen::Index interval, const std::function<void(const SplinePriorTerm&)>& visit);

}  // namespace kinfer
