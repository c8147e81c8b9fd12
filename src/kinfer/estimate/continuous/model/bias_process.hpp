// SPDX-License-Identifier: Apache-2.0
// Time-varying biases: constant over a time segment, a first-order Gauss-Markov process from one segment to the next.
//
//   w₀ ~ N(0, σ²),  w_k = a w_{k−1} + N(0, σ² (1 − a²)),  a = exp(−segment length / correlation time)
//
// A long recording thus needs no constant bias; with σ = 0 the biases are constant.
#pragma once

#include "kinfer/estimate/continuous/model/problem.hpp"

namespace kinfer {

/// Time segments of the grid: 64 intervals each, in long recordings 128, independent of the number of threads; the last
/// one takes the remainder.
struct TimeSegment {
  Eigen::Index first = 0, end = 0;  ///< intervals
};
std::vector<TimeSegment> time_segments_of(const SplineGrid& grid);
Eigen::Index time_segment_at(const SplineGrid& grid, Eigen::Index interval);

/// Errors of a sensor in an interval: constants plus the segment's bias deviations.
InsErrors errors_at(const InsProblem& problem, const InsUnknowns& x, std::size_t sensor, Eigen::Index interval);

/// The process between neighbouring segments, for each of a segment's unknowns.
struct BiasProcessPrior {
  double decay = 0.0;    ///< a
  VectorXd information;  ///< 1/σ² of each unknown
  VectorXd innovation;   ///< 1/(σ² (1 − a²))
};
BiasProcessPrior bias_process_prior(const InsProblem& problem, const InsLayout& layout);

/// Global parameters that a segment's bias deviations add to, in their order.
std::vector<Eigen::Index> bias_parameters(const InsLayout& layout);

/// Σ of the squared, whitened process noise.
double bias_process_cost(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x);

}  // namespace kinfer
