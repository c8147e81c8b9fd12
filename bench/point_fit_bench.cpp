// SPDX-License-Identifier: Apache-2.0
// A whole fit of paper 2's case from the nominal numbers, 50 poses and 24 parameters, beside Ceres with automatic
// derivatives; and the bootstrap of it on one and two threads.
#include <benchmark/benchmark.h>

#include "kinfer/base/expect.hpp"
#include "kinfer/estimate/poses/bootstrap.hpp"
#include "kinfer/estimate/poses/point_fit.hpp"
#include "paper2_case.hpp"
#include "peers/ceres_jets.hpp"
#include "ratios.hpp"

namespace kinfer::bench {
using namespace calibrate;
namespace {

ParameterSet without_priors(ParameterSet set) {
  for (Parameter& p : set.parameters) p.prior_sd = std::numeric_limits<double>::infinity();
  return set;
}

void cold_fit(benchmark::State& state) {
  const Paper2Case& c = paper2_case();
  const ParameterSet set = without_priors(c.set);
  LeastSquaresOptions options = options_near_optimum();
  options.target_cost = 1e-8;  // sigma²; Ceres ends by itself at 9e-9
  LeastSquaresOutcome outcome;
  for (auto _ : state) {  // a cold fit includes the preparation of the data set
    const BatchPoints points(c.nominal, set, c.table);
    outcome = fit_points(points, set, points.weights(Eigen::Matrix3Xd::Constant(3, poses, 1e5)), c.start, options);
  }
  KINFER_EXPECT(outcome.cost <= options.target_cost, "the noise-free case is left with {} sigma²", outcome.cost);
  state.counters["iterations"] = outcome.iterations;
  state.counters["cost"] = outcome.cost;
}
BENCHMARK(cold_fit)->Unit(benchmark::kMicrosecond);

void ceres_cold_fit(benchmark::State& state) {
  const Paper2Case& c = paper2_case();
  const JetPoints points(c.table.joints.data(), c.table.measured.data(), poses, 1e5);
  double cost = 0.0;
  for (auto _ : state) {
    VectorXd x = c.start;
    cost = points.fit(x.data());
  }
  state.counters["cost"] = cost;
}
BENCHMARK(ceres_cold_fit)->Unit(benchmark::kMicrosecond);

void bootstrap_1000(benchmark::State& state) {
  const Paper2Case& c = paper2_case();
  const PoseSet data = test::measured(test::with_table3_errors(c.nominal), test::paper2_poses(poses, test::tracker));
  const Weights weights = weights_of(data, test::tracker);
  const Chain truth = test::with_table3_errors(c.nominal);
  const BootstrapOptions options{.threads = static_cast<int>(state.range(0))};
  for (auto _ : state) benchmark::DoNotOptimize(bootstrap(truth, c.set, data, weights, options, Rng(1)));
}
BENCHMARK(bootstrap_1000)
    ->Arg(1)
    ->Arg(2)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond)
    ->Repetitions(61)  // both cores are rarely idle at the same time
    ->ComputeStatistics("fastest", fastest);

}  // namespace
}  // namespace kinfer::bench
