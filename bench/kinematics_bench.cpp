// SPDX-License-Identifier: Apache-2.0
// Forward kinematics and derivatives: the batch kernels beside naive Eigen, Orocos KDL and Ceres' Jets, and beside the
// peak of the core's multiply-adds. Items are poses.
#include <benchmark/benchmark.h>

#include "kinfer/base/expect.hpp"
#include "kinfer/kinematics/batch/batch_points.hpp"
#include "kinfer/kinematics/batch/batch_population.hpp"
#include "kinfer/kinematics/poses/batch_poses.hpp"
#include "paper2_case.hpp"
#include "peers/ceres_jets.hpp"
#include "peers/fma_peak.hpp"
#include "peers/naive_eigen.hpp"
#include "peers/orocos_kdl.hpp"

namespace kinfer::bench {
using namespace calibrate;
namespace {

void count_poses(benchmark::State& state, int a_round) {
  state.SetItemsProcessed(state.iterations() * a_round);
}

void naive_fitness(benchmark::State& state) {
  const Paper2Case& c = paper2_case();
  constexpr int few = 10;  // candidates: the naive version is slow
  double sum = 0.0;
  for (auto _ : state)
    for (int p = 0; p < few; ++p)
      benchmark::DoNotOptimize(sum +=
                               naive_sum(c.swarm.col(p).data(), c.table.joints.data(), c.table.measured.data(), poses));
  count_poses(state, few * poses);
}
BENCHMARK(naive_fitness);

void expect_naive_sums(const std::vector<double>& sums, double tolerance) {
  const Paper2Case& c = paper2_case();
  for (int p = 0; p < particles; ++p) {
    const double naive = naive_sum(c.swarm.col(p).data(), c.table.joints.data(), c.table.measured.data(), poses);
    KINFER_EXPECT(std::abs(sums[p] - naive) <= tolerance * naive, "{} by the kernel, {} by the naive version", sums[p],
                  naive);
  }
}

template <class T>
void population_fitness(benchmark::State& state, const batch::Kernels& kernels) {
  const Paper2Case& c = paper2_case();
  const BatchPopulation<T> population(c.nominal, c.set, c.table, kernels);
  std::vector<double> sums(particles);
  for (auto _ : state) population.sums(c.swarm, sums);
  expect_naive_sums(sums, sizeof(T) == 8 ? 1e-12 : 1e-2);
  count_poses(state, particles * poses);
}

/// One candidate, lanes are poses: as a fit evaluates it.
void errors_of_one_candidate(benchmark::State& state, const batch::Kernels& kernels) {
  const Paper2Case& c = paper2_case();
  const BatchPoints points(c.nominal, c.set, c.table, kernels);
  BatchPoints::Scratch scratch;
  for (auto _ : state) benchmark::DoNotOptimize(points.lane_errors(c.start, scratch));
  count_poses(state, poses);
}

void residuals_and_jacobian(benchmark::State& state, const batch::Kernels& kernels) {
  const Paper2Case& c = paper2_case();
  const BatchPoints points(c.nominal, c.set, c.table, kernels);
  const BatchPoints::Weights weights = points.weights(Eigen::Matrix3Xd::Constant(3, poses, 1e5));
  BatchPoints::Scratch scratch;
  for (auto _ : state) benchmark::DoNotOptimize(points.lane_jacobian(c.start, weights, scratch));
  count_poses(state, poses);
}

void normal_equations(benchmark::State& state, const batch::Kernels& kernels) {
  const Paper2Case& c = paper2_case();
  const BatchPoints points(c.nominal, c.set, c.table, kernels);
  const BatchPoints::Weights weights = points.weights(Eigen::Matrix3Xd::Constant(3, poses, 1e5));
  BatchPoints::Scratch scratch;
  MatrixXd matrix;
  VectorXd gradient;
  for (auto _ : state) points.normal_equations(c.start, weights, matrix, gradient, scratch);
  count_poses(state, poses);
}

/// The arm with a mass on each link, compliant joints and a series of 40 harmonics each.
Chain yielding_arm() {
  Chain chain = paper2_case().nominal;
  for (std::size_t j = 0; j < chain.joints.size(); ++j) {
    chain.masses.push_back({static_cast<int>(j), Vec3(0.1, 0.0, 0.05), 10.0});
    chain.joints[j].compliance = 1e-6;
    for (int order = 0; order < 40; ++order) chain.joints[j].harmonics.push_back({1.0 * order, 1e-5, 2e-5});
  }
  return chain;
}

void yielding_poses(benchmark::State& state, const batch::Kernels& kernels) {
  const Paper2Case& c = paper2_case();
  const BatchPoses batch(yielding_arm(), c.set, kernels);
  std::vector<Pose> at(poses);
  std::vector<Twists> twists(poses);
  std::vector<PoseRow> rows;
  for (int i = 0; i < poses; ++i) rows.push_back({c.table.joints.col(i).data(), {}, &at[i], &twists[i]});
  BatchPoses::Scratch scratch;
  for (auto _ : state) batch.evaluate(rows, scratch);
  count_poses(state, poses);
}

void yielding_poses_one_by_one(benchmark::State& state) {
  const Paper2Case& c = paper2_case();
  const PoseEvaluator evaluator(yielding_arm(), c.set);
  Twists twists;
  for (auto _ : state)
    for (int i = 0; i < poses; ++i)
      benchmark::DoNotOptimize(evaluator.pose_and_derivative(c.table.joints.col(i), {}, twists));
  count_poses(state, poses);
}
BENCHMARK(yielding_poses_one_by_one);

void kdl_position(benchmark::State& state) {
  const Paper2Case& c = paper2_case();
  KdlChain chain(c.start.data());
  Vec3 at;
  for (auto _ : state)
    for (int i = 0; i < poses; ++i) {
      chain.position(c.table.joints.col(i).data(), at.data());
      benchmark::DoNotOptimize(at);
    }
  Vec3 naive;
  naive_position(c.start.data(), c.table.joints.col(poses - 1).data(), naive.data());
  KINFER_EXPECT((at - naive).norm() < 1e-12, "KDL's chain differs");
  count_poses(state, poses);
}
BENCHMARK(kdl_position);

void ceres_jets(benchmark::State& state) {
  const Paper2Case& c = paper2_case();
  const JetPoints points(c.table.joints.data(), c.table.measured.data(), poses, 1e5);
  VectorXd r(3 * poses);
  Eigen::Matrix<double, Eigen::Dynamic, 24, Eigen::RowMajor> jacobian(3 * poses, 24);
  for (auto _ : state) {
    points.evaluate(c.start.data(), r.data(), jacobian.data());
    benchmark::DoNotOptimize(jacobian.data());
  }
  count_poses(state, poses);
}
BENCHMARK(ceres_jets);

/// Items are multiply-adds of one number.
void fma_peak(benchmark::State& state, void (*run)(int), int lanes) {
  constexpr int rounds = 10000;
  for (auto _ : state) run(rounds);
  state.SetItemsProcessed(state.iterations() * std::int64_t{10} * rounds * lanes);
}

/// Every kernel that this processor supports.
[[maybe_unused]] const bool registered = [] {
  const batch::KernelList list = batch::runnable_kernels();
  for (int i = 0; i < list.count; ++i) {
    const batch::Kernels& kernels = *list.kernels[i];
    const auto add = [&](const std::string& name, auto function) {
      benchmark::RegisterBenchmark((name + "/" + kernels.name).c_str(),
                                   [function, &kernels](benchmark::State& state) { function(state, kernels); });
    };
    add("population_double", population_fitness<double>);
    add("population_float", population_fitness<float>);
    add("errors", errors_of_one_candidate);
    add("jacobian", residuals_and_jacobian);
    add("normal_equations", normal_equations);
    add("yielding_poses", yielding_poses);
    if (kernels.lanes == 4) benchmark::RegisterBenchmark("fma_peak/AVX2 + FMA", fma_peak, multiply_adds_avx2, 4);
    if (kernels.lanes == 8) benchmark::RegisterBenchmark("fma_peak/AVX-512", fma_peak, multiply_adds_avx512, 8);
  }
  return true;
}();

}  // namespace
}  // namespace kinfer::bench
