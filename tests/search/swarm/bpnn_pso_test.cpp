// SPDX-License-Identifier: Apache-2.0
#include "kinfer/search/swarm/bpnn_pso.hpp"

#include <gtest/gtest.h>

#include "search/swarm_problems.hpp"

namespace kinfer {
namespace {

using testing::shifted_sphere;

constexpr Budget to_one_percent{.max_iterations = 2000, .target_cost = 1e-6};

SearchOutcome cold_run() {
  return bpnn_particle_swarm(shifted_sphere(10), {.pso = {.budget = to_one_percent}}, Rng(1));
}

TEST(BpnnPso, WithoutANetItIsPlainPso) {
  const SearchOutcome plain = particle_swarm(shifted_sphere(10), {.budget = to_one_percent}, Rng(1));
  EXPECT_EQ(cold_run().x, plain.x);
  EXPECT_EQ(cold_run().best, plain.best);
}

TEST(BpnnPso, TheNetOfOneRunPredictsASwarmAroundItsOptimum) {
  const SearchOutcome first = cold_run();
  const MatrixXd predicted = predict(*first.net, uniform_swarm(testing::cube(10, 1.0), 50, Rng(2)));
  EXPECT_LT((predicted.rowwise().mean() - first.x).cwiseAbs().maxCoeff(), 0.05);
  EXPECT_LT((predicted.colwise() - first.x).cwiseAbs().mean(), 0.1);  // a uniform draw from ±1 has 0.5 and more
}

TEST(BpnnPso, TheNextRunOnTheSameProblemNeedsFewerIterations) {
  const SearchOutcome first = cold_run();
  const SearchOutcome next =
      bpnn_particle_swarm(shifted_sphere(10), {.pso = {.budget = to_one_percent}, .net = first.net}, Rng(2));
  EXPECT_EQ(next.stop, Stop::target_reached);
  EXPECT_LT(next.iterations, 0.6 * first.iterations);
}

TEST(BpnnPso, ApplyingTheNetBeforeEveryUpdateKeepsTheSwarmFromAMovedOptimum) {
  const SearchOutcome first = cold_run();
  // The same robot, after a collision: the optimum moved to −0.4.
  const Objective moved =
      testing::objective_of(testing::cube(10, 1.0), [](const VectorXd& x) { return (x.array() + 0.4).square().sum(); });
  const BpnnPsoOptions faithful{.pso = {.budget = {.max_iterations = 300}}, .net = first.net};
  BpnnPsoOptions literal = faithful;
  literal.use = NetUse::before_every_update;
  EXPECT_LT(bpnn_particle_swarm(moved, faithful, Rng(2)).cost, 1e-6);
  EXPECT_GT(bpnn_particle_swarm(moved, literal, Rng(2)).cost, 1e-3);
}

TEST(BpnnPso, TheNumberOfHiddenNodesFollowsTheOption) {
  const Objective objective = shifted_sphere(10);
  const auto nodes = [&](HiddenNodes how) {
    return train_on_swarm(objective.bounds, uniform_swarm(objective.bounds, 50, Rng(1)), VectorXd::Constant(10, 0.3),
                          how, {.epochs = 50}, 1, Rng(2))
        .hidden_nodes();
  };
  EXPECT_EQ(nodes(HiddenNodes::figure), 70);
  EXPECT_EQ(nodes(HiddenNodes::formula), 14);
  EXPECT_GE(nodes(HiddenNodes::stepwise), 5);
}

}  // namespace
}  // namespace kinfer
