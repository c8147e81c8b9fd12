// SPDX-License-Identifier: Apache-2.0
// pagmo's PSO and CMA-ES on paper 2's problem with the naive fitness.
#pragma once

#include <vector>

namespace kinfer::bench {

struct SwarmProblem {
  std::vector<double> lower, upper, joints, measured;
  int poses = 0;
};

struct SwarmResult {
  double cost = 0.0;
  std::vector<double> x;
  long long evaluations = 0;
};

SwarmResult pagmo_pso(const SwarmProblem& problem, int particles, int iterations, unsigned seed);
SwarmResult pagmo_cmaes(const SwarmProblem& problem, int particles, int iterations, unsigned seed);

}  // namespace kinfer::bench
