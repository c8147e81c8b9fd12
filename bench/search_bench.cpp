// SPDX-License-Identifier: Apache-2.0
// Paper 2's search end to end: 200 particles, 50 poses, 404 iterations, beside pagmo's PSO and CMA-ES with the naive
// fitness; all on one thread.
#include <benchmark/benchmark.h>

#include "kinfer/base/expect.hpp"
#include "kinfer/calibrate/swarm/swarm_fitness.hpp"
#include "kinfer/search/swarm/pso.hpp"
#include "paper2_case.hpp"
#include "peers/naive_eigen.hpp"
#include "peers/pagmo_swarm.hpp"

namespace kinfer::bench {
using namespace calibrate;
namespace {

constexpr int iterations = 404;

Bounds box() {
  const Paper2Case& c = paper2_case();
  VectorXd half(c.start.size());
  const auto free = c.set.free();
  for (Eigen::Index k = 0; k < half.size(); ++k) half[k] = free[k]->quantity == Quantity::length ? 1e-3 : degree;
  return {c.start - half, c.start + half};
}

SwarmProblem swarm_problem() {
  const Paper2Case& c = paper2_case();
  const Bounds bounds = box();
  const auto list = [](const auto& m) { return std::vector<double>(m.data(), m.data() + m.size()); };
  return {list(bounds.lower), list(bounds.upper), list(c.table.joints), list(c.table.measured), poses};
}

void kinfer_pso(benchmark::State& state) {
  const Paper2Case& c = paper2_case();
  const SwarmFitness fitness(c.nominal, c.set, c.data);
  const Objective objective{box(), [&](ConstMatrixRef x, std::span<double> cost) { fitness.sums(x, cost); }};
  PsoOptions options;
  options.budget = {.max_iterations = iterations, .threads = 1};
  SearchOutcome outcome;
  for (auto _ : state) outcome = particle_swarm(objective, options, Rng(1));
  for (Eigen::Index p = 0; p < outcome.final_swarm.cols(); ++p) {
    const VectorXd x = outcome.final_swarm.col(p);
    double ours = 0.0;
    fitness.sums(x, {&ours, 1});
    const double naive = naive_sum(x.data(), c.table.joints.data(), c.table.measured.data(), poses);
    KINFER_EXPECT(std::abs(ours - naive) <= 1e-12, "{} m² by the kernel, {} m² by the naive fitness", ours, naive);
  }
  state.counters["rms_um"] = 1e6 * std::sqrt(outcome.cost / poses);
}
BENCHMARK(kinfer_pso)->Unit(benchmark::kMillisecond);

void by_pagmo(benchmark::State& state, SwarmResult (*search)(const SwarmProblem&, int, int, unsigned)) {
  const SwarmProblem problem = swarm_problem();
  SwarmResult result;
  for (auto _ : state) result = search(problem, particles, iterations, 1);
  state.counters["rms_um"] = 1e6 * std::sqrt(result.cost / poses);
  state.counters["evaluations"] = static_cast<double>(result.evaluations);
}
BENCHMARK_CAPTURE(by_pagmo, pso, pagmo_pso)->Unit(benchmark::kMillisecond)->Iterations(1)->Repetitions(3);
BENCHMARK_CAPTURE(by_pagmo, cmaes, pagmo_cmaes)->Unit(benchmark::kMillisecond)->Iterations(1)->Repetitions(3);

}  // namespace
}  // namespace kinfer::bench
