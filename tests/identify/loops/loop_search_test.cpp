// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/loops/loop_search.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "kinfer/identify/loops/loop_fit.hpp"
#include "kinfer/identify/loops/thresholds.hpp"

namespace kinfer {
using namespace identify;
namespace {

constexpr double ground = 0.45, crank = 0.35, rocker = 0.36, coupler = 0.47;  // [m]

/// Joint positions of crank, rocker and coupler [rad].
using Positions = std::array<double, 3>;

/// Closed: the coupler's end holds the crank's, by the law of cosines.
Positions closed_at(double crank_position) {
  const double phi = crank_position + 1.0, x = ground + crank * std::cos(phi), y = crank * std::sin(phi);
  const double square = x * x + y * y;
  const double turn =
      std::atan2(y, x) + std::acos((rocker * rocker + square - coupler * coupler) / (2.0 * rocker * std::sqrt(square)));
  return {phi, turn, std::atan2(y - rocker * std::sin(turn), x - rocker * std::cos(turn)) - turn};
}

struct FittedBars {
  InsProblem problem;
  InsFit fit;
};

/// A ground with a crank, and a rocker with a coupler, in the plane across z, moving for 20 s.
FittedBars bars(const std::function<Positions(double)>& positions_at) {
  FittedBars b;
  b.problem.grid = {.begin = 0.0, .period = 0.1, .intervals = 200};
  b.problem.sensors.resize(4);
  const auto pivot = [](int parent, int sensor, double x) {
    InsBody body = revolute_body(parent, sensor, Mat3::Identity(), Mat3::Identity());
    body.point_in_parent = Vec3(x, 0.0, 0.0);
    return body;
  };
  InsUnknowns& x = b.fit.unknowns;
  x.bodies = {{.sensor = 0}, pivot(0, 1, ground), pivot(0, 2, 0.0), pivot(2, 3, rocker)};
  x.errors.resize(4);
  std::vector<double> time;
  for (int i = 0; i <= 2000; ++i) time.push_back(0.01 * i);
  MatrixXd values(static_cast<Eigen::Index>(time.size()), 3);
  for (std::size_t i = 0; i < time.size(); ++i) {
    const Positions q = positions_at(time[i]);
    values.row(static_cast<Eigen::Index>(i)) << q[0], q[1], q[2];
  }
  x.spline_coefficients = fit_spline(b.problem.grid, time, values);
  b.fit.layout = layout_of(b.problem, x.bodies);
  return b;
}

double swing(double time) {
  return 0.4 * std::sin(1.3 * time) + 0.2 * std::sin(0.7 * time + 1.0);
}

TEST(LoopSearch, FindsTheJointBetweenCrankAndCoupler) {
  const FittedBars b = bars([](double time) { return closed_at(swing(time)); });
  const std::vector<FoundLoop> loops = find_loops(b.problem, b.fit);
  ASSERT_EQ(loops.size(), 1U);
  EXPECT_EQ(loops[0].first, 1U);
  EXPECT_EQ(loops[0].second, 3U);
  EXPECT_EQ(loops[0].joints, (std::vector<std::size_t>{1, 2, 3}));
  const InsBody& joint = loops[0].evidence.closing.joint;
  EXPECT_LT((joint.point_in_parent - Vec3(crank, 0.0, 0.0)).head<2>().norm(), 1e-3);
  EXPECT_LT((joint.point_in_child - Vec3(coupler, 0.0, 0.0)).head<2>().norm(), 1e-3);
  EXPECT_GT(loops[0].log_odds, 20.0);
}

TEST(LoopSearch, BarsThatMoveAsTheyLikeCloseNone) {
  const FittedBars b = bars([](double time) {
    return Positions{swing(time), 0.5 * std::sin(0.9 * time), 0.5 * std::sin(1.9 * time + 0.4)};
  });
  ASSERT_EQ(loop_candidates(b.problem, b.fit).size(), 1U);
  EXPECT_LT(loop_candidates(b.problem, b.fit)[0].log_odds, -100.0);
  EXPECT_TRUE(find_loops(b.problem, b.fit).empty());
}

TEST(LoopSearch, BarsThatMoveInStepCloseNone) {
  for (const double size : {0.02, 0.05, 0.1, 0.2, 0.5}) {  // [rad]
    const FittedBars b = bars([&](double time) {
      const double s = size * swing(time) / 0.4;
      return Positions{1.0 * s, 0.3 - 0.8 * s, 0.7 + 0.6 * s};
    });
    EXPECT_TRUE(find_loops(b.problem, b.fit).empty()) << size;
  }
}

TEST(LoopSearch, ALoopWhoseJointsHardlyMoveIsNotJudged) {
  const FittedBars b = bars([](double time) { return closed_at(0.02 * swing(time)); });
  EXPECT_TRUE(loop_candidates(b.problem, b.fit).empty());
}

TEST(ClosureOf, IsHeldAtEveryKnotButAtAtMostSoManyTimes) {
  const FittedBars b = bars([](double time) { return closed_at(swing(time)); });
  const FoundLoop loop = find_loops(b.problem, b.fit).front();
  const InsClosure closure = closure_of(loop, b.problem.grid);
  EXPECT_EQ(closure.at.size(), 200U);
  EXPECT_NEAR(closure.point_sd, closure_point_sd * std::sqrt(10.0), 1e-9) << "ten times a second";
  SplineGrid hour = b.problem.grid;
  hour.intervals = 36000;
  EXPECT_LE(closure_of(loop, hour).at.size(), static_cast<std::size_t>(max_closure_times));
  EXPECT_GE(closure_of(loop, hour).point_sd, closure_point_sd);
}

}  // namespace
}  // namespace kinfer
