// SPDX-License-Identifier: Apache-2.0
#include "kinfer/search/swarm/pso.hpp"

#include <algorithm>
#include <limits>
#include <vector>

#include "kinfer/base/expect.hpp"
#include "kinfer/base/instruction_set.hpp"
#include "kinfer/search/swarm/swarm_kernel.hpp"

namespace kinfer {
namespace {

double inertia_at(const PsoOptions& options, int iteration) {
  if (options.final_inertia < 0.0) return options.inertia;
  const double share = double(iteration) / std::max(1, options.budget.max_iterations);
  return options.inertia + share * (options.final_inertia - options.inertia);
}

/// r1 and r2 of eq. (9), alternating: one pair per dimension, or the same pair for all.
void draw_pairs(RandomNumbers how, Rng draw, std::span<double> pairs) {
  if (how == RandomNumbers::per_dimension) return draw.uniform(pairs);
  draw.uniform(pairs.first(2));
  for (std::size_t i = 2; i < pairs.size(); ++i) pairs[i] = pairs[i - 2];
}

search::SwarmKernel best_swarm_kernel() {
#if defined(__x86_64__)
  if (instruction_set() == InstructionSet::avx512) return search::swarm_avx512;
  if (instruction_set() == InstructionSet::avx2) return search::swarm_avx2;
#endif
  return search::move_particle;
}

/// Limits of positions and velocities.
struct Limits {
  VectorXd max_velocity, lower, upper;

  Limits(const PsoOptions& options, const Bounds& box) : lower(box.lower), upper(box.upper) {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    max_velocity = VectorXd::Constant(box.size(), infinite);
    if (options.velocity_limit > 0.0) max_velocity = 2.0 * options.velocity_limit * box.half_width();
    if (options.boundary == BoundaryHandling::open) lower.setConstant(-infinite), upper.setConstant(infinite);
  }

  search::SwarmStep step(const PsoOptions& options, double inertia, const VectorXd& swarm_best) const {
    return {.dim = static_cast<int>(max_velocity.size()),
            .inertia = inertia,
            .cognitive = options.cognitive,
            .social = options.social,
            .swarm_best = swarm_best.data(),
            .max_velocity = max_velocity.data(),
            .lower = lower.data(),
            .upper = upper.data(),
            .absorbs = options.boundary == BoundaryHandling::absorb};
  }
};

MatrixXd first_swarm(const Objective& objective, const PsoOptions& options, Rng rng) {
  if (options.initial.size() == 0) return uniform_swarm(objective.bounds, options.particles, rng);
  KINFER_EXPECT(options.initial.rows() == objective.bounds.size() && options.initial.cols() > 0,
                "an initial swarm of {} x {} in a box of {}", options.initial.rows(), options.initial.cols(),
                objective.bounds.size());
  return clamped(options.initial, objective.bounds);
}

}  // namespace

SearchOutcome particle_swarm(const Objective& objective, const PsoOptions& options, Rng rng, const Observer& observer,
                             const SwarmMap& before_every_update) {
  BatchEvaluator evaluator(objective, options.budget.threads);
  SearchHistory history(options.budget, observer);
  const Rng moves = rng.stream(1);
  const search::SwarmKernel move = best_swarm_kernel();
  const Limits limits(options, objective.bounds);

  MatrixXd x = first_swarm(objective, options, rng.stream(0));
  MatrixXd v = MatrixXd::Zero(x.rows(), x.cols());
  PersonalBests own;
  std::vector<double> pairs(2 * x.rows());
  for (int iteration = 1;; ++iteration) {
    const std::vector<double> cost = evaluator(x);
    own.update(x, cost);
    if (history.add(x, cost)) break;

    if (before_every_update) x = clamped(before_every_update(x), objective.bounds);
    const search::SwarmStep step = limits.step(options, inertia_at(options, iteration), history.best());
    const Rng draws = moves.stream(iteration);
    for (Eigen::Index p = 0; p < x.cols(); ++p) {
      draw_pairs(options.random_numbers, draws.stream(p), pairs);
      move(step, pairs.data(), own.x.col(p).data(), x.col(p).data(), v.col(p).data());
    }
  }
  return history.finish(evaluator, std::move(x));
}

}  // namespace kinfer
