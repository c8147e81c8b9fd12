// SPDX-License-Identifier: Apache-2.0
#include "kinfer/plan/plan_poses.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "kinfer/calibrate/fit/tolerance_fit.hpp"
#include "kinfer/estimate/poses/pose_residuals.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/plan/lower_bound.hpp"
#include "kinfer/plan/optimal_design.hpp"
#include "kinfer/plan/pose_order.hpp"
#include "kinfer/simulate/pose_set.hpp"
#include "support/robots.hpp"

namespace kinfer {
using namespace calibrate;
using namespace plan;
namespace {

constexpr Criterion all_criteria[] = {Criterion::tool, Criterion::worst, Criterion::d, Criterion::a, Criterion::e};

MatrixXd random_matrix(Eigen::Index rows, Eigen::Index columns, double size, Rng rng) {
  MatrixXd m(rows, columns);
  for (double& value : m.reshaped()) value = size * rng.normal();
  return m;
}

/// Nine candidates of five unknowns, few enough to enumerate.
DesignProblem small_problem() {
  DesignProblem problem;
  problem.rows = random_matrix(27, 5, 3.0, Rng(1));
  problem.targets = random_matrix(12, 5, 1e-3, Rng(2));
  return problem;
}

TEST(Design, ExchangeFindsTheBestOfAllTriples) {
  const DesignProblem problem = small_problem();
  for (const Criterion criterion : all_criteria) {
    double best = std::numeric_limits<double>::infinity();
    for (int a = 0; a < 9; ++a)
      for (int b = a + 1; b < 9; ++b)
        for (int c = b + 1; c < 9; ++c)
          best = std::min(best, objective(problem, criterion, information(problem, {a, b, c})));
    const std::vector<int> found = best_design(problem, criterion, 3, 3, 1, Rng(3));
    const double value = objective(problem, criterion, information(problem, found));
    EXPECT_LE(value, best + 0.02 * std::abs(best)) << static_cast<int>(criterion);
  }
}

TEST(Design, ObjectivesAreWhatTheySay) {
  const DesignProblem problem = small_problem();
  const MatrixXd lambda = information(problem, {0, 4});
  const MatrixXd sigma = solve_spd(lambda, VectorXd::Unit(5, 0)) ? *invert_spd(lambda) : MatrixXd();
  const VectorXd values = symmetric_eigen(lambda).values;
  EXPECT_NEAR(objective(problem, Criterion::d, lambda), -values.array().log().sum(), 1e-9);
  EXPECT_NEAR(objective(problem, Criterion::a, lambda), values.array().inverse().sum(), 1e-9);
  EXPECT_NEAR(objective(problem, Criterion::e, lambda), 1.0 / values[0], 1e-9);
  const MatrixXd spread = problem.targets * sigma * problem.targets.transpose();
  EXPECT_NEAR(objective(problem, Criterion::tool, lambda), spread.trace() / 4.0, 1e-15);
  const double worst = objective(problem, Criterion::worst, lambda);
  EXPECT_LE(worst, tool_variances(problem, sigma).maxCoeff());
  EXPECT_GE(worst, 0.8 * tool_variances(problem, sigma).maxCoeff());
}

TEST(Design, NoChoiceIsBetterThanTheBoundAndManyPosesComeCloseToIt) {
  const DesignProblem problem = small_problem();
  for (int a = 0; a < 9; ++a)
    for (int b = a; b < 9; ++b)
      for (int c = b; c < 9; ++c)
        EXPECT_GE(objective(problem, Criterion::tool, information(problem, {a, b, c})),
                  mean_square_lower_bound(problem, 3));
  const std::vector<int> many = greedy_design(problem, Criterion::tool, 9);
  EXPECT_GE(objective(problem, Criterion::tool, information(problem, many)), mean_square_lower_bound(problem, 9));
  DesignProblem alone = problem;
  alone.rows = problem.rows.topRows(3).eval();
  const double only_one = objective(alone, Criterion::tool, information(alone, {0}));
  EXPECT_NEAR(mean_square_lower_bound(alone, 1), only_one, 1e-12 * only_one);
}

TEST(Design, CopiesAreRedundant) {
  DesignProblem problem = small_problem();
  problem.rows *= 100.0;  // little noise, so that fewer rows than unknowns cost accuracy
  problem.rows.bottomRows(3) = 1e-3 * problem.rows.topRows(3);
  const std::vector<int> gone = find_redundant(problem, Criterion::tool, 0.01);
  EXPECT_TRUE(std::find(gone.begin(), gone.end(), 8) != gone.end());
  EXPECT_LT(gone.size(), 9u);
}

TEST(Design, CandidatesTooCloseAreNotChosenTogether) {
  DesignProblem problem = small_problem();
  problem.too_close = [](int a, int b) { return std::abs(a - b) == 1; };
  const std::vector<int> found = best_design(problem, Criterion::d, 5, 2, 1, Rng(1));
  for (const int a : found)
    for (const int b : found) EXPECT_NE(std::abs(a - b), 1);
}

PlanTask er20_task() {
  PlanTask task;
  task.nominal = test::er20();
  task.nominal.tool.xyz = {0.03, -0.02, 0.1};
  task.instrument = test::tracker;
  return task;
}

TEST(PlanPoses, PosesKeepToLimitsFloorViewAndSpacing) {
  PlanTask task = er20_task();
  task.space = {.lowest = 0.1, .clearance = 0.3, .instrument = Vec3(2.5, 1.0, 1.2)};
  const PlanOptions options{.poses = 12, .candidates = 200, .starts = 0};
  const PosePlan plan = plan_poses(task, options, Rng(1)).value();
  ASSERT_EQ(plan.joints.cols(), 12);
  for (Eigen::Index i = 0; i < 12; ++i) {
    const VectorXd q = plan.joints.col(i);
    for (Eigen::Index k = 0; k < 6; ++k) {
      EXPECT_GT(q[k], task.nominal.joints[k].lower);
      EXPECT_LT(q[k], task.nominal.joints[k].upper);
    }
    const Pose tool = forward(task.nominal, q);
    EXPECT_GE(tool.position.z(), 0.1);
    EXPECT_GE(tool.position.head<2>().norm(), 0.3);
    EXPECT_LE(angle_between(Vec3(tool.rotation.col(2)), Vec3(*task.space.instrument - tool.position)), 60.001 * degree);
    for (Eigen::Index j = 0; j < i; ++j) EXPECT_GE((q - plan.joints.col(j)).cwiseAbs().maxCoeff(), options.spacing);
  }
}

TEST(PlanPoses, SamePosesForAnyNumberOfThreads) {
  const PlanTask task = er20_task();
  const auto with = [&](int threads) {
    return plan_poses(task, {.poses = 8, .candidates = 150, .threads = threads}, Rng(4)).value().joints;
  };
  const MatrixXd one = with(1);
  EXPECT_EQ(one, with(2));
  EXPECT_EQ(one, with(7));
}

TEST(PlanPoses, OrderingIsAPermutationThatTravelsLess) {
  const PosePlan plan = plan_poses(er20_task(), {.poses = 15, .candidates = 300, .starts = 0}, Rng(1)).value();
  EXPECT_LT(plan.travel, plan.travel_unordered);
  const std::vector<int> order = order_by_travel(er20_task().nominal, plan.joints);
  EXPECT_EQ(std::set<int>(order.begin(), order.end()).size(), 15u);
}

TEST(PlanPoses, ExistingPosesCountAndLowerTheExpectedError) {
  PlanTask task = er20_task();
  task.candidates = draw_poses(task.nominal, {}, 200, Rng(9)).value();
  const PosePlan alone = plan_poses(task, {.poses = 10, .starts = 0}, Rng(1)).value();
  task.existing.joints = draw_poses(task.nominal, {}, 30, Rng(8)).value();
  const PosePlan added = plan_poses(task, {.poses = 10, .starts = 0}, Rng(1)).value();
  EXPECT_LT(added.expected.rms, alone.expected.rms);
  EXPECT_LT(added.expected.rms, added.existing.rms);
  EXPECT_EQ(alone.candidates.size(), 10u);
  for (Eigen::Index i = 0; i < 10; ++i) EXPECT_EQ(alone.joints.col(i), task.candidates.col(alone.candidates[i]));
}

TEST(PlanPoses, ObservabilityIndicesAreThoseOfTheSingularValues) {
  PlanTask task = er20_task();
  task.candidates = draw_poses(task.nominal, {}, 100, Rng(9)).value();
  const PosePlan plan = plan_poses(task, {.poses = 20, .starts = 0}, Rng(1)).value();
  EXPECT_EQ(plan.rank, 27);  // four parameters of six joints, and the base position
  const auto [o1, o2, o3, o4, o5] = plan.observability;
  EXPECT_NEAR(o4, o2 * o3, 1e-9 * o4);
  EXPECT_LT(o5, o3);
  EXPECT_GT(o1, o3 / std::sqrt(20.0));
}

TEST(PlanPoses, AnEmptyPoseSpaceIsAnError) {
  PlanTask task = er20_task();
  task.space.lowest = 50.0;
  EXPECT_FALSE(plan_poses(task, {.poses = 5}, Rng(1)).has_value());
}

TEST(PlanPoses, FifteenPlannedPosesCalibrateBetterThanFifteenRandomOnes) {
  const PlanTask task = er20_task();
  const MatrixXd planned = plan_poses(task, {.poses = 15, .candidates = 500, .starts = 1}, Rng(1)).value().joints;
  const MatrixXd elsewhere = draw_poses(task.nominal, {}, 300, Rng(2)).value();
  const auto worst = [&](int draw, const MatrixXd& q) {
    const Chain truth = with_random_errors(task.nominal, {}, Rng(10).stream(draw));
    const CalibrationTask fit{.nominal = task.nominal,
                              .tolerances = {},
                              .instrument = test::tracker,
                              .data = simulate_points(truth, q, test::tracker, Rng(20).stream(draw))};
    const std::vector<double> errors = point_errors(fit_once(fit, fit.data, GeometricParameters{}, {}).value().chain,
                                                    simulate_points(truth, elsewhere));
    return *std::max_element(errors.begin(), errors.end());
  };
  std::vector<double> by_plan, by_chance;
  for (int draw = 0; draw < 11; ++draw) {
    by_plan.push_back(worst(draw, planned));
    by_chance.push_back(worst(draw, draw_poses(task.nominal, {}, 15, Rng(30).stream(draw)).value()));
  }
  EXPECT_LT(median(by_plan), 0.8 * median(by_chance));
}

}  // namespace
}  // namespace kinfer
