// SPDX-License-Identifier: Apache-2.0
// One iteration of the continuous-time fit, residuals, derivatives, elimination and step, for recordings of 1, 10 and
// 60 minutes of six sensors on five joints, knots of 0.1 s: the work does not depend on the measured values.
#include <benchmark/benchmark.h>

#include "kinfer/estimate/continuous/solver/normal_equations.hpp"
#include "kinfer/geometry/random.hpp"

namespace {

using namespace kinfer;
using Eigen::Index;

constexpr double minute = 60.0, knots = 0.1;  // [s]

std::vector<InsBlock> blocks(Index intervals, int rows, Rng& rng) {
  std::vector<InsBlock> all(static_cast<std::size_t>(intervals));
  for (InsBlock& block : all) {
    block.rows = block.samples = rows;
    for (Index i = 0; i < rows; ++i)
      for (Index j = i; j < block_nodes; ++j) block.factor(i, j) = static_cast<float>(rng.normal());
  }
  return all;
}

struct Case {
  InsProblem problem;
  InsUnknowns x;
  InsLayout layout;
};

Case example(Index intervals) {
  Rng rng(1);
  Case c;
  c.problem.grid = {.begin = 0.0, .period = knots, .intervals = intervals};
  c.problem.prior = {1e-3, 1e-2, 5e-4, 3e-4};
  c.x.bodies = {{.sensor = 0}};
  for (int s = 0; s < 6; ++s) {
    InsMeasurements& sensor = c.problem.sensors.emplace_back();
    sensor.angular_velocity = blocks(intervals, block_nodes, rng);
    sensor.force = blocks(intervals, block_nodes, rng);
    if (s == 0) continue;
    const Mat3 parent_R_axis = exp_so3(normal_vector(rng)), child_R_axis = exp_so3(normal_vector(rng));
    c.x.bodies.push_back(revolute_body(s - 1, s, parent_R_axis, child_R_axis));
    c.x.bodies.back().point_in_parent = normal_vector(rng);
    c.x.bodies.back().point_in_child = normal_vector(rng);
  }
  c.x.root_force = Vec3(0.0, 0.0, 9.81);
  c.x.errors.resize(6);
  c.x.spline_coefficients = MatrixXd(5, c.problem.grid.coefficients());
  for (double& value : c.x.spline_coefficients.reshaped()) value = 0.1 * rng.normal();
  c.layout = layout_of(c.problem, c.x.bodies);
  return c;
}

void continuous_fit_iteration(benchmark::State& state) {
  const auto minutes = static_cast<double>(state.range(0));
  const Case c = example(static_cast<Index>(minutes * minute / knots));
  for (auto _ : state) benchmark::DoNotOptimize(InsSystem(c.problem, c.layout, c.x, {}, 1).solve());
  state.counters["s/minute"] =
      benchmark::Counter(minutes, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(continuous_fit_iteration)->Arg(1)->Arg(10)->Arg(60)->Unit(benchmark::kMillisecond)->ArgName("minutes");

}  // namespace
