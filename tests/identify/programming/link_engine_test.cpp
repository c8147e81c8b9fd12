// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/programming/link_engine.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "identify/example_machine.hpp"

namespace kinfer {
using namespace identify;
namespace {

struct EngineRow {
  LinkEngine engine;
  LinkSearchMethod method;
  JointVariableKind terminals;
  OrientationMetric metric;
  bool continues;
};

const EngineRow engine_rows[] = {
    {MemeticProgramming{}, LinkSearchMethod::memetic, JointVariableKind::hinge, OrientationMetric::chord, false},
    {Enumeration{}, LinkSearchMethod::enumeration, JointVariableKind::hinge, OrientationMetric::chord, false},
    {BacterialProgramming{}, LinkSearchMethod::bacterial, JointVariableKind::hinge, OrientationMetric::chord, true},
    {BacterialProgramming{.terminals = JointVariableKind::euler}, LinkSearchMethod::bacterial, JointVariableKind::euler,
     OrientationMetric::euler, true}};

TEST(LinkEngine, EachMethodHasItsOwnTerminalsAndMetric) {
  for (const EngineRow& row : engine_rows) {
    EXPECT_EQ(method_of(row.engine), row.method);
    EXPECT_EQ(terminals_of(row.engine), row.terminals);
    EXPECT_EQ(orientation_metric(row.engine), row.metric);
    EXPECT_EQ(continues_chain(row.engine), row.continues) << "only paper 1 starts from the chain before the link";
  }
}

struct LinkExample {
  std::vector<JointSignal> signals{test::wave(0.6, 0.9, 1.0)};
  std::vector<FrameState> parent = test::swinging_parent(test::wave(0.5, 0.7, 0.3));
  std::vector<FrameState> child = propagate(parent, test::general_hinge(), signals);
  std::vector<std::size_t> rows = test::all_rows(600);

  LinkSolution solved(const LinkEngine& engine, int threads) const {
    return search_link(engine, {parent, child, signals, rows}, threads, Rng(3), {});
  }
  double error_of(const LinkSolution& found) const {
    return j_rmse(propagate(parent, found.leaves, signals), child, rows, OrientationMetric::chord).total;
  }
};

BacterialProgramming short_bacterial() {
  BacterialProgramming engine;
  engine.bacteria.individuals = 20;
  engine.bacteria.generations = 40;
  engine.rows = 100;
  return engine;
}

TEST(LinkEngine, MemeticAndExhaustiveSearchFindAGeneralRevoluteJoint) {
  const LinkExample link;
  for (const LinkEngine& engine : {LinkEngine(MemeticProgramming{.rows = 150}), LinkEngine(Enumeration{.rows = 150})}) {
    const LinkSolution found = link.solved(engine, 0);
    EXPECT_LT(link.error_of(found), 0.02);
    EXPECT_EQ(count_signal_uses(found.leaves), 1);
    EXPECT_EQ(found.rows.size(), 150U);
    EXPECT_GT(found.evaluations, 0);
  }
}

TEST(LinkEngine, BacterialProgrammingNeverLosesItsBest) {
  const LinkExample link;
  const LinkSolution found = link.solved(short_bacterial(), 0);
  ASSERT_EQ(found.best.size(), 41U) << "the initial population and 40 generations";
  EXPECT_TRUE(std::ranges::is_sorted(found.best, std::greater<>{}));
  EXPECT_LT(found.best.back(), 0.7 * found.best.front());
  for (std::size_t g = 0; g < found.best.size(); ++g) EXPECT_LE(found.best[g], found.median[g]);
  EXPECT_GE(count_signal_uses(found.leaves), 1);
}

TEST(LinkEngine, AnObserverMayEndASearch) {
  const LinkExample link;
  for (const LinkEngine& engine : {LinkEngine(MemeticProgramming{.rows = 60}), LinkEngine(short_bacterial()),
                                   LinkEngine(Enumeration{.rows = 60})}) {
    int calls = 0;
    const Observer after_two = [&](const Progress&) {
      return ++calls < 2 ? ObserverDecision::proceed : ObserverDecision::stop;
    };
    const LinkSolution found =
        search_link(engine, {link.parent, link.child, link.signals, link.rows}, 1, Rng(3), after_two);
    EXPECT_EQ(calls, 2);
    EXPECT_LE(found.generations, 2);
    EXPECT_FALSE(found.leaves.empty()) << "the best so far";
    EXPECT_LT(found.evaluations, link.solved(engine, 1).evaluations);
  }
}

TEST(LinkEngine, EveryMethodGivesTheSameBitsForAnyNumberOfThreads) {
  const LinkExample link;
  for (const LinkEngine& engine : {LinkEngine(MemeticProgramming{.rows = 80}), LinkEngine(Enumeration{.rows = 80}),
                                   LinkEngine(short_bacterial())}) {
    const LinkSolution one = link.solved(engine, 1);
    for (const int threads : {2, 7}) {
      const LinkSolution many = link.solved(engine, threads);
      EXPECT_EQ(one.best, many.best);
      ASSERT_EQ(one.leaves.size(), many.leaves.size());
      for (std::size_t i = 0; i < one.leaves.size(); ++i) {
        EXPECT_EQ(one.leaves[i].theta, many.leaves[i].theta);
        EXPECT_EQ(one.leaves[i].a, many.leaves[i].a);
      }
    }
  }
}

TEST(LinkEngine, FittedRowsAreEvenlySpreadOverThoseThatMayBeFitted) {
  LinkExample link;
  link.rows.erase(link.rows.begin() + 100, link.rows.begin() + 400);
  const LinkSolution found = link.solved(MemeticProgramming{.rows = 60}, 0);
  EXPECT_EQ(found.rows, thin_rows(link.rows, 60));
  EXPECT_TRUE(std::ranges::includes(link.rows, found.rows));
  EXPECT_GT(found.rows.back(), 580U);
}

TEST(ThinRows, KeepsFewRowsAndSpacesManyEvenly) {
  EXPECT_EQ(thin_rows({3, 5, 8}, 10), (std::vector<std::size_t>{3, 5, 8}));
  EXPECT_TRUE(thin_rows({}, 10).empty());
  const auto rows = thin_rows(test::all_rows(1000), 100);
  ASSERT_EQ(rows.size(), 100U);
  for (std::size_t i = 1; i < rows.size(); ++i) EXPECT_NEAR(static_cast<double>(rows[i] - rows[i - 1]), 10.0, 1.0);
}

TEST(LinkCost, EulerAnglesAndChordAgreeOnSmallErrors) {
  const LinkExample link;
  std::vector<FrameState> rotated = link.child;
  for (FrameState& s : rotated) s.rotation = rot_z(1e-3) * s.rotation;  // about the vertical: yaw alone changes
  const JRmse euler = j_rmse(rotated, link.child, link.rows, OrientationMetric::euler),
              chord = j_rmse(rotated, link.child, link.rows, OrientationMetric::chord);
  EXPECT_NEAR(euler.orientation, 1e-3, 1e-8);
  EXPECT_NEAR(chord.orientation, 1e-3, 1e-8);
  EXPECT_EQ(euler.acceleration, 0.0);
}

}  // namespace
}  // namespace kinfer
