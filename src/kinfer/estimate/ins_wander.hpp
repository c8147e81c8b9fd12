// Biases that wander: constant over a stretch of the recording, a Gauss-Markov process from one stretch to the next.
//
//   w₀ ~ N(0, σ²),  w_k = a w_{k−1} + N(0, σ² (1 − a²)),  a = exp(−length of a stretch / time)
//
// So a long recording is not asked to have one bias from beginning to end; with σ = 0 it is.
#pragma once

#include "kinfer/estimate/ins_problem.hpp"

namespace kinfer {

/// The grid's intervals by stretches, 64 each and in long recordings 128, whatever the number of threads; the last one
/// takes the remainder.
struct InsStretch {
  Eigen::Index first = 0, end = 0;  ///< intervals
};
std::vector<InsStretch> stretches_of(const SplineGrid& grid);
Eigen::Index stretch_at(const SplineGrid& grid, Eigen::Index interval);

/// What is wrong with a sensor's readings in an interval: constants and what its biases wandered off.
InsErrors errors_at(const InsProblem& problem, const InsUnknowns& x, std::size_t sensor, Eigen::Index interval);

/// The process between neighbouring stretches, for each of a stretch's unknowns.
struct WanderPrior {
  double keep = 0.0;     ///< a
  VectorXd information;  ///< 1/σ² of each unknown
  VectorXd innovation;   ///< 1/(σ² (1 − a²))
};
WanderPrior wander_prior(const InsProblem& problem, const InsLayout& layout);

/// Border unknowns that the unknowns of a stretch are added to, in their order.
std::vector<Eigen::Index> wandering_border(const InsLayout& layout);

/// Σ of the process' squared surprises.
double wander_cost(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x);

}  // namespace kinfer
