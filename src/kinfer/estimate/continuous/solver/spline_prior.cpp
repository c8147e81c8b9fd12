// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/solver/spline_prior.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;
using SplineWeights = Eigen::Matrix<double, spline_order, 1>;

/// Standard deviation of the third difference of a dimension's coefficients: [unit/s³] times period cubed. Far above
/// what hand-held shaking reaches: it only bridges gaps without measurements.
double roughness_sd(const InsProblem& problem, Index spline_dimension) {
  constexpr double joint = 3e4, root_rate = 1e6, root_force = 1e7;
  const double h = problem.grid.period, cubed = h * h * h;
  if (problem.root_at_rest || spline_dimension >= 6) return joint * cubed;
  return (spline_dimension < 3 ? root_rate : root_force) * cubed;
}

constexpr double weak_anchor_sd = 3.0;  // [rad] or [m]
constexpr double travel_sd = 3.0;       // [m] from the first to the last position of a slide

/// Standard deviation of the difference of neighbouring coefficients before a dimension's first measurement and after
/// its last. Extrapolated by third differences alone, a spline has no finite uncertainty after some seconds, and the
/// normal equations no numerical inverse. Per second: 10 rad of a joint, 30 rad/s and 300 m/s² of the root.
double extrapolation_sd(const InsProblem& problem, Index spline_dimension) {
  constexpr double joint = 10.0, root_rate = 30.0, root_force = 300.0;
  if (problem.root_at_rest || spline_dimension >= 6) return joint * problem.grid.period;
  return (spline_dimension < 3 ? root_rate : root_force) * problem.grid.period;
}

}  // namespace

void each_spline_prior(const InsProblem& problem, const InsLayout& layout, ConstMatrixRef coefficients, Index interval,
                       const std::function<void(const SplinePriorTerm&)>& visit) {
  const bool last = interval + 1 == problem.grid.intervals;
  for (Index spline_dimension = 0; spline_dimension < layout.spline_dimensions; ++spline_dimension) {
    const double sd = roughness_sd(problem, spline_dimension);
    for (Index shift = 0; shift <= (last ? 2 : 0); ++shift) {
      SplineWeights weights = SplineWeights::Zero();
      weights.segment<4>(shift) << -1.0, 3.0, -3.0, 1.0;
      visit({spline_dimension, weights,
             weights.dot(coefficients.row(spline_dimension).segment<spline_order>(interval).transpose()), sd});
    }
    if (!layout.measured[static_cast<std::size_t>(spline_dimension)].holds(interval)) {
      const double step_sd = extrapolation_sd(problem, spline_dimension);
      const Index begin = interval == 0 ? 0 : 2, end = last ? spline_order - 1 : 3;
      for (Index shift = begin; shift < end; ++shift) {
        SplineWeights weights = SplineWeights::Zero();
        weights.segment<2>(shift) << -1.0, 1.0;
        visit({spline_dimension, weights,
               weights.dot(coefficients.row(spline_dimension).segment<spline_order>(interval).transpose()), step_sd});
      }
    }
    if (last && layout.only_accelerates[static_cast<std::size_t>(spline_dimension)]) {
      const double start = problem.anchor.empty() ? 0.0 : problem.anchor[static_cast<std::size_t>(spline_dimension)];
      const Index end = problem.grid.coefficients() - 1;
      visit({spline_dimension, SplineWeights::Unit(spline_order - 1), coefficients(spline_dimension, end) - start,
             travel_sd});
    }
    const Index joint = spline_dimension - (problem.root_at_rest ? 0 : 6);
    if (interval == 0 && joint >= 0) {
      const double start = problem.anchor.empty() ? 0.0 : problem.anchor[static_cast<std::size_t>(joint)];
      const double anchor_sd =
          problem.anchor_sd.empty() ? weak_anchor_sd : problem.anchor_sd[static_cast<std::size_t>(joint)];
      visit({spline_dimension, SplineWeights::Unit(0), coefficients(spline_dimension, 0) - start, anchor_sd});
    }
  }
}

}  // namespace kinfer
