// SPDX-License-Identifier: Apache-2.0
// The methods that the study compares, run on one problem.
#pragma once

#include <string>
#include <vector>

#include "kinfer/evidence/calibration/fit_errors.hpp"
#include "kinfer/search/swarm/minimise.hpp"
#include "problem.hpp"

namespace kinfer::paper2 {

enum class Method {
  pso_printed,         ///< uniform initial swarm, w = 0.9
  pso,                 ///< uniform initial swarm, w = 0.8
  bpnn_pso,            ///< initial swarm by the net of the earlier identification
  bpnn_literal,        ///< the net before every update
  warm_start,          ///< one particle starts at the earlier optimum, no net
  draw_compact_swarm,  ///< about the nominal numbers, independent of earlier results
  qpso,
  lm,      ///< Levenberg-Marquardt with analytic Jacobian, no priors
  map_lm,  ///< the same with the tolerances as priors
};
inline constexpr Method all_methods[] = {Method::pso_printed,  Method::pso,        Method::bpnn_pso,
                                         Method::bpnn_literal, Method::warm_start, Method::draw_compact_swarm,
                                         Method::qpso,         Method::lm,         Method::map_lm};
std::string name(Method method);

/// Result of an earlier identification of the same robot.
struct Earlier {
  VectorXd x{};
  Mlp net;
  double training_seconds = 0.0;
};
Earlier identify_before(const Problem& problem, int seed);

struct Trial {
  Method method{};
  int iterations = -1;            ///< to the target rms; -1: not within the budget
  int iterations_to_sum = -1;     ///< to a sum of 5.55e-5 mm², the other interpretation of the paper's fitness
  long long evaluations = 0;      ///< until the target, or all; a Jacobian counts as 24
  double seconds = 0.0;           ///< of the search until the target
  double training_seconds = 0.0;  ///< before the search
  VectorXd x{};
  std::vector<double> best{};  ///< [m²] sum of squares after each iteration
  ErrorStatistics fitted{}, held_out{};
  double predicted_rms = 0.0;  ///< [m] of the held-out poses, by the covariance (map_lm only)
};
struct Effort {
  int max_iterations = 1000;
  int threads = 1;
};
Trial run(Method method, const Problem& problem, const Earlier& earlier, int seed, const Effort& effort = {});

}  // namespace kinfer::paper2
