// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/programming/memetic_search.hpp"

#include <gtest/gtest.h>

#include "identify/example_machine.hpp"

namespace kinfer {
using namespace identify;
namespace {

using test::all_rows;
using test::general_hinge;
using test::swinging_parent;
using test::wave;

struct Link {
  JointSignal hinge = wave(0.6, 0.9, 1.0);
  std::vector<FrameState> parent = swinging_parent(wave(0.5, 0.7, 0.3));
  std::vector<FrameState> child = propagate(parent, general_hinge(), {&hinge, 1});
  std::vector<std::size_t> rows = all_rows(600);

  /// With an INS' noise, of the accelerations only.
  Link with_noise(std::uint64_t seed) const {
    Link link = *this;
    Rng rng(seed);
    for (FrameState& state : link.child)
      for (double& a : state.acceleration) a += 0.02 * rng.normal();
    return link;
  }
};

TEST(LinkStructure, EnumerationHasTheExpectedCount) {
  // One signal in one of 2 n angles, with or without a constant offset; the other angles constant or zero.
  EXPECT_EQ(enumerate_structures(1).size(), 8u);
  EXPECT_EQ(enumerate_structures(2).size(), 8u + 64u);
  EXPECT_EQ(enumerate_structures(3).size(), 8u + 64u + 384u);
}

TEST(LinkStructure, OperatorsKeepTheSignalOnceAndTheLeavesFew) {
  const StructureOperators breed;
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    const LinkStructure a = breed.random(Rng(seed)), b = breed.random(Rng(seed + 1000));
    for (const LinkStructure& s : {a, breed.mutate(a, a.leaves.size() - 1, Rng(seed)),
                                   breed.transfer(a, 0, b, b.leaves.size() - 1, Rng(seed))}) {
      EXPECT_TRUE(uses_signal_once(s)) << text(s);
      EXPECT_TRUE(!s.leaves.empty() && s.leaves.size() <= max_structure_leaves);
    }
    for (const LinkStructure& s : neighbour_structures(a)) EXPECT_TRUE(uses_signal_once(s) && s != a);
  }
}

TEST(StructureFitter, FindsANoiseFreeRevoluteJointToRounding) {
  const Link link;
  const StructureFitter problem(link.parent, link.child, {&link.hinge, 1}, link.rows, {.length_prior = 1e-6});
  const StructureFit fit = problem.fit(revolute_structure());
  EXPECT_LT(fit.j, 1e-5);
  const auto found = propagate(link.parent, fit.leaves, {&link.hinge, 1});
  for (const std::size_t row : {3u, 200u, 590u}) {
    EXPECT_LT((found[row].rotation - link.child[row].rotation).norm(), 1e-5);
    EXPECT_LT((found[row].acceleration - link.child[row].acceleration).norm(), 1e-4);
  }
}

TEST(StructureFitter, JEqualsTheReference) {
  const Link link = Link().with_noise(3);
  const StructureFit fit = StructureFitter(link.parent, link.child, {&link.hinge, 1}, link.rows,
                                           {.length_prior = 1e-5, .bias_prior = 1e3})  // no biases
                               .fit(revolute_structure());
  const JRmse slow =
      j_rmse(propagate(link.parent, fit.leaves, {&link.hinge, 1}), link.child, link.rows, OrientationMetric::chord);
  EXPECT_NEAR(fit.j, slow.total, 1e-6 * slow.total);
}

TEST(MemeticSearch, EndsAtTheOptimumOfExhaustiveSearch) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Link link = Link().with_noise(seed);
    const auto found = search_memetic(link.parent, link.child, {&link.hinge, 1}, link.rows, {}, Rng(seed));
    const auto best = search_exhaustive(link.parent, link.child, {&link.hinge, 1}, link.rows, {});
    EXPECT_LT(found.cost, best.cost * 1.001) << text(found.structure) << " against " << text(best.structure);
    EXPECT_LT(found.evaluations, 5000);
    EXPECT_LT(found.j, 0.02 * std::sqrt(3.0) * 1.1);
  }
}

TEST(MemeticSearch, GivesTheSameBitsForAnyNumberOfThreads) {
  const Link link = Link().with_noise(7);
  const auto run = [&](int threads) {
    MemeticProgramming options;
    options.bacteria.threads = threads;
    return search_memetic(link.parent, link.child, {&link.hinge, 1}, link.rows, options, Rng(2));
  };
  const StructureSearchOutcome one = run(1);
  for (const int threads : {2, 7}) {
    const StructureSearchOutcome many = run(threads);
    EXPECT_EQ(one.best_history, many.best_history);
    EXPECT_EQ(one.median_history, many.median_history);
    EXPECT_EQ(one.evaluations, many.evaluations);
    EXPECT_EQ(one.leaves.front().theta, many.leaves.front().theta);
  }
}

}  // namespace
}  // namespace kinfer
