// SPDX-License-Identifier: Apache-2.0
// Designs in a space of poses without a list, and the order in which they are measured.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kinfer/plan/lower_bound.hpp"
#include "kinfer/plan/optimal_design.hpp"
#include "kinfer/plan/pose_order.hpp"
#include "support/robots.hpp"

namespace kinfer {
using namespace plan;
namespace {

constexpr Criterion every_criterion[] = {Criterion::tool, Criterion::worst, Criterion::d, Criterion::a, Criterion::e};

/// A parabola y = a + b x + c x² on [-1, 1], measured with unit noise, with wide priors.
struct Parabola {
  DesignProblem problem;
  JacobianRows rows_of = [](ConstVectorRef pose) {
    MatrixXd rows = MatrixXd::Zero(3, 3);  // only one of the three coordinates tells anything
    rows.row(0) << 30.0, 30.0 * pose[0], 30.0 * pose[0] * pose[0];
    return rows;
  };
  PoseProposer propose = [](ConstVectorRef pose, Rng& rng) {
    VectorXd next = pose;
    next[0] = std::clamp(pose[0] + 0.3 * rng.normal(), -1.0, 1.0);
    return next;
  };

  Parabola() {
    problem.targets = MatrixXd::Zero(3 * 21, 3);
    for (int place = 0; place < 21; ++place)
      problem.targets.row(3 * place) = rows_of(VectorXd::Constant(1, -1.0 + 0.1 * place)).row(0);
    problem.rows = MatrixXd::Zero(0, 3);
  }
  double value(Criterion criterion, const MatrixXd& poses) const {
    MatrixXd lambda = MatrixXd::Identity(3, 3);
    for (Eigen::Index i = 0; i < poses.cols(); ++i) lambda += rows_of(poses.col(i)).transpose() * rows_of(poses.col(i));
    return objective(problem, criterion, lambda);
  }
  MatrixXd refined(Criterion criterion, const MatrixXd& start, std::uint64_t seed = 1) const {
    return refined_design(
        problem, criterion, start, rows_of, propose, [](const MatrixXd&, Eigen::Index) { return true; }, Rng(seed));
  }
};

TEST(RefinedDesign, OfAParabolaMeasuresTheEndsAndTheMiddle) {
  const Parabola parabola;
  MatrixXd start(1, 3);
  start << -0.4, 0.1, 0.3;
  const MatrixXd found = parabola.refined(Criterion::d, start);
  std::vector<double> poses(found.data(), found.data() + found.size());
  std::ranges::sort(poses);
  EXPECT_NEAR(poses[0], -1.0, 0.02);
  EXPECT_NEAR(poses[1], 0.0, 0.05) << "the D-optimal design of a parabola (Guest 1958)";
  EXPECT_NEAR(poses[2], 1.0, 0.02);
}

TEST(RefinedDesign, NeverRaisesItsCriterion) {
  const Parabola parabola;
  MatrixXd start(1, 4);
  start << -0.9, -0.1, 0.2, 0.8;
  for (const Criterion criterion : every_criterion) {
    const double before = parabola.value(criterion, start),
                 after = parabola.value(criterion, parabola.refined(criterion, start));
    EXPECT_LE(after, before + 1e-9 * std::abs(before)) << name(criterion);
  }
}

TEST(RefinedDesign, LeavesPosesWhereNothingIsAllowedOrProposed) {
  const Parabola parabola;
  MatrixXd start(1, 3);
  start << -0.4, 0.1, 0.3;
  const auto never = [](const MatrixXd&, Eigen::Index) { return false; };
  const auto nothing = [](ConstVectorRef, Rng&) { return VectorXd(); };
  EXPECT_EQ(refined_design(parabola.problem, Criterion::a, start, parabola.rows_of, parabola.propose, never, Rng(1)),
            start);
  EXPECT_EQ(refined_design(
                parabola.problem, Criterion::a, start, parabola.rows_of, nothing,
                [](const MatrixXd&, Eigen::Index) { return true; }, Rng(1)),
            start);
}

TEST(RefinedDesign, DependsOnItsSeedOnly) {
  const Parabola parabola;
  MatrixXd start(1, 3);
  start << -0.4, 0.1, 0.3;
  EXPECT_EQ(parabola.refined(Criterion::tool, start, 5), parabola.refined(Criterion::tool, start, 5));
}

/// Eleven positions on the parabola as a list.
DesignProblem listed_parabola() {
  Parabola parabola;
  parabola.problem.rows.resize(33, 3);
  for (int k = 0; k < 11; ++k)
    parabola.problem.rows.middleRows(3 * k, 3) = parabola.rows_of(VectorXd::Constant(1, -1.0 + 0.2 * k));
  return parabola.problem;
}

TEST(Design, GreedySequencesAreNested) {
  const DesignProblem problem = listed_parabola();
  for (const Criterion criterion : every_criterion) {
    const std::vector<int> six = greedy_design(problem, criterion, 6), three = greedy_design(problem, criterion, 3);
    EXPECT_TRUE(std::equal(three.begin(), three.end(), six.begin())) << name(criterion);
  }
}

TEST(Design, TheBestThreeOfAParabolaAreItsEndsAndItsMiddle) {
  std::vector<int> chosen = best_design(listed_parabola(), Criterion::d, 3, 2, 1, Rng(1));
  std::ranges::sort(chosen);
  EXPECT_EQ(chosen, (std::vector{0, 5, 10}));
}

TEST(Design, EarlierMeasurementsChangeWhatIsWorthMeasuring) {
  DesignProblem problem = listed_parabola();
  EXPECT_LE(mean_square_lower_bound(problem, 3),
            objective(problem, Criterion::tool,
                      information(problem, best_design(problem, Criterion::tool, 3, 2, 1, Rng(1)))));
  const MatrixXd end = problem.rows.row(30);
  problem.prior_information = 1e3 * end.transpose() * end;  // the right end is known
  const std::vector<int> chosen = best_design(problem, Criterion::tool, 2, 2, 1, Rng(1));
  EXPECT_EQ(std::ranges::count(chosen, 10), 0);
}

TEST(Design, TheSameForAnyNumberOfThreads) {
  const DesignProblem problem = listed_parabola();
  const auto one = best_design(problem, Criterion::e, 4, 6, 1, Rng(3));
  for (const int threads : {2, 7}) EXPECT_EQ(best_design(problem, Criterion::e, 4, 6, threads, Rng(3)), one);
}

TEST(PoseOrder, IsTheShortestOfAllForAFewPoses) {
  const Chain chain = test::er20();
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Rng rng(seed);
    MatrixXd q(6, 6);
    for (double& value : q.reshaped()) value = rng.uniform(-1.0, 1.0);
    const std::vector<int> found = order_by_travel(chain, q);
    std::vector<int> order(6);
    std::iota(order.begin(), order.end(), 0);
    ASSERT_TRUE(std::ranges::is_permutation(found, order));
    double shortest = 1e9, longest = 0.0;
    do {
      if (order[0] != found[0]) continue;  // the first pose is the one in the middle
      shortest = std::min(shortest, travel(q, order)), longest = std::max(longest, travel(q, order));
    } while (std::ranges::next_permutation(order).found);
    EXPECT_LE(travel(q, found), shortest + 0.25 * (longest - shortest)) << seed;
  }
}

TEST(PoseOrder, PosesOnALineAreVisitedOneAfterTheOther) {
  MatrixXd q = MatrixXd::Zero(6, 7);
  for (int k = 0; k < 7; ++k) q(0, k) = 0.1 * ((3 * k) % 7);  // shuffled
  const std::vector<int> order = order_by_travel(test::er20(), q);
  EXPECT_NEAR(travel(q, order), 0.6, 1e-12);
  EXPECT_TRUE(order_by_travel(test::er20(), MatrixXd(6, 0)).empty());
  EXPECT_EQ(travel(q, {3}), 0.0);
}

}  // namespace
}  // namespace kinfer
