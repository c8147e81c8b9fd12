// SPDX-License-Identifier: Apache-2.0
#include "peers/pagmo_swarm.hpp"

#include <pagmo/algorithm.hpp>
#include <pagmo/algorithms/cmaes.hpp>
#include <pagmo/algorithms/pso.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>

#include "peers/naive_eigen.hpp"

namespace kinfer::bench {
namespace {

/// Pagmo's interface of a problem.
struct NaiveFitness {
  const SwarmProblem* problem = nullptr;

  pagmo::vector_double fitness(const pagmo::vector_double& x) const {
    return {naive_sum(x.data(), problem->joints.data(), problem->measured.data(), problem->poses)};
  }
  std::pair<pagmo::vector_double, pagmo::vector_double> get_bounds() const { return {problem->lower, problem->upper}; }
};

template <class Algorithm>
SwarmResult evolve(const SwarmProblem& problem, Algorithm how, int particles, unsigned seed) {
  const pagmo::algorithm algorithm(how);
  pagmo::population population(pagmo::problem(NaiveFitness{&problem}), particles, seed);
  population = algorithm.evolve(population);
  return {population.champion_f()[0], population.champion_x(),
          static_cast<long long>(population.get_problem().get_fevals())};
}

}  // namespace

SwarmResult pagmo_pso(const SwarmProblem& problem, int particles, int iterations, unsigned seed) {
  constexpr double inertia = 0.8, own = 0.5, swarm = 1.25, fastest = 0.5;
  constexpr unsigned inertia_weight = 1, global_best = 1;  // variant and neighbourhood: paper 2's eq. (9)
  return evolve(problem,
                pagmo::pso(iterations, inertia, own, swarm, fastest, inertia_weight, global_best, 4, false, seed),
                particles, seed);
}

SwarmResult pagmo_cmaes(const SwarmProblem& problem, int particles, int iterations, unsigned seed) {
  return evolve(problem, pagmo::cmaes(iterations, -1, -1, -1, -1, 0.5, 1e-12, 1e-30, false, true, seed), particles,
                seed);
}

}  // namespace kinfer::bench
