// SPDX-License-Identifier: Apache-2.0
#include "kinfer/search/least_squares/least_squares.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "kinfer/base/parallel.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "search/standard_problems.hpp"
#include "support/differences.hpp"

namespace kinfer {
namespace {

using testing::numeric_jacobian;
using testing::standard_problems;

constexpr double infinite = std::numeric_limits<double>::infinity();

VectorXd residuals_at(const Residuals& problem, const VectorXd& x) {
  VectorXd r(problem.rows);
  problem.evaluate(x, r, nullptr);
  return r;
}

MatrixXd jacobian_at(const Residuals& problem, const VectorXd& x) {
  VectorXd r(problem.rows);
  MatrixXd jacobian(problem.rows, problem.unknowns);
  problem.evaluate(x, r, &jacobian);
  return jacobian;
}

MatrixXd random_matrix(Eigen::Index rows, Eigen::Index cols, Rng rng) {
  return MatrixXd::NullaryExpr(rows, cols, [&] { return rng.normal(); });
}

/// r = a x − b
Residuals linear(const MatrixXd& a, const VectorXd& b) {
  return {a.cols(), a.rows(), {}, [a, b](ConstVectorRef x, VectorXd& r, MatrixXd* j) {
            r = a * x - b;
            if (j) *j = a;
          }};
}

/// One unknown, one row.
template <class Value, class Slope>
Residuals scalar(Value value, Slope slope) {
  return {1, 1, {}, [=](ConstVectorRef x, VectorXd& r, MatrixXd* j) {
            r[0] = value(x[0]);
            if (j) (*j)(0, 0) = slope(x[0]);
          }};
}

const VectorXd unit_start = VectorXd::Ones(1);

TEST(LeastSquares, StandardProblemsEndAtTheOptimumThatTheLiteraturePrints) {
  for (const auto& problem : standard_problems()) {
    const auto fit = least_squares(problem.residuals, problem.start, {.max_iterations = 500});
    EXPECT_TRUE(converged(fit.stop)) << problem.name << ": " << name(fit.stop);
    EXPECT_NEAR(fit.cost, problem.optimum, 1e-5 * problem.optimum + 1e-24) << problem.name;
  }
}

TEST(LeastSquares, DerivativesOfTheTestProblemsAgreeWithDifferences) {
  auto problems = standard_problems();
  problems.push_back({"line", testing::line_with_outliers(), Eigen::Vector2d(1, 1), 0.0});
  problems.push_back({"planar pose", testing::planar_pose_with_outliers(), Eigen::Vector3d(0.3, 1, 1), 0.0});
  for (const auto& problem : problems) {
    const auto f = [&](const VectorXd& x) { return residuals_at(problem.residuals, x); };
    const MatrixXd analytic = jacobian_at(problem.residuals, problem.start);
    EXPECT_LT((analytic - numeric_jacobian(f, problem.start)).norm(), 1e-6 * analytic.norm()) << problem.name;
  }
}

TEST(LeastSquares, OutcomeDescribesThePointThatItReturns) {
  for (const auto& problem : standard_problems()) {
    const auto fit = least_squares(problem.residuals, problem.start, {.max_iterations = 5});
    EXPECT_EQ(fit.residuals, residuals_at(problem.residuals, fit.x)) << problem.name;
    EXPECT_EQ(fit.jacobian, jacobian_at(problem.residuals, fit.x)) << problem.name;
    EXPECT_DOUBLE_EQ(fit.cost, fit.residuals.squaredNorm());
    EXPECT_EQ(fit.history.size(), fit.iterations + 1u);
    EXPECT_EQ(fit.history.back(), fit.cost);
    EXPECT_TRUE(std::is_sorted(fit.history.rbegin(), fit.history.rend())) << problem.name;
  }
}

TEST(LeastSquares, OutcomeCountsTheCalls) {
  auto problem = testing::rosenbrock();
  int calls = 0, with_jacobian = 0;
  const auto inner = problem.residuals.evaluate;
  problem.residuals.evaluate = [&](ConstVectorRef x, VectorXd& r, MatrixXd* j) {
    ++calls;
    with_jacobian += j != nullptr;
    inner(x, r, j);
  };
  const auto fit = least_squares(problem.residuals, problem.start);
  EXPECT_EQ(fit.evaluations, calls);
  EXPECT_EQ(fit.jacobians, with_jacobian);
  EXPECT_EQ(fit.not_finite, 0);
}

TEST(LeastSquares, ANoiseFreeFitConvergesDownToRounding) {
  const auto problem = testing::exponential();
  const auto fit = least_squares(problem.residuals, problem.start);
  EXPECT_TRUE(converged(fit.stop)) << name(fit.stop);
  EXPECT_LT(fit.cost,
            20 * 1e-30);  // 20 residuals of numbers of 1 .. 5, each with a rounding error of at most 1e-15
  EXPECT_NEAR(fit.x[0], 0.3, 2e-15);
  EXPECT_NEAR(fit.x[1], 0.1, 2e-15);
}

TEST(LeastSquares, ANoiseFreeFitConvergesDownToRoundingWithUnknownsOfVeryDifferentSizes) {
  // Condition 1e8 before scaling: columns of 1e-4 and 1e4.
  MatrixXd a = random_matrix(30, 6, Rng(8));
  a.leftCols(3) *= 1e-4;
  a.rightCols(3) *= 1e4;
  const VectorXd truth = random_matrix(6, 1, Rng(9));
  const auto fit = least_squares(linear(a, a * truth), VectorXd::Zero(6));
  EXPECT_TRUE(converged(fit.stop)) << name(fit.stop);
  EXPECT_LT(fit.cost, 30 * std::pow(1e4 * 1e-15, 2));
}

TEST(LeastSquares, ARedundantLinearProblemIsSolvedByTheSmallestChange) {
  // Rank 4 of 7 unknowns: the start plus the pseudo-inverse's step is the nearest of all optima.
  const MatrixXd a = random_matrix(40, 4, Rng(1)) * random_matrix(4, 7, Rng(2));
  const VectorXd start = random_matrix(7, 1, Rng(4));
  for (const double noise : {0.0, 1.0}) {
    const VectorXd b = a * random_matrix(7, 1, Rng(3)) + noise * random_matrix(40, 1, Rng(5));
    const VectorXd nearest = start + solve_least_squares(a, b - a * start, 1e-10);
    const auto fit = least_squares(linear(a, b), start, {.scale = VectorXd::Ones(7)});
    EXPECT_TRUE(converged(fit.stop)) << name(fit.stop);
    EXPECT_LT((fit.x - nearest).norm(), 1e-10) << "noise " << noise;
  }
}

TEST(LeastSquares, TheSmallestChangeIsCountedInTypicalSizes) {
  // x0 + x1 = 1 from (0, 0): the change is shared as the squares of the sizes, 4 : 1.
  const Residuals sum = linear(Eigen::RowVector2d(1, 1), unit_start);
  const auto fit = least_squares(sum, Eigen::Vector2d(0, 0), {.scale = VectorXd(Eigen::Vector2d(2, 1))});
  EXPECT_NEAR(fit.x[0], 0.8, 1e-12);
  EXPECT_NEAR(fit.x[1], 0.2, 1e-12);
}

TEST(LeastSquares, ARedundantNonlinearProblemDoesNotDriftHoweverLongItRuns) {
  // Ten noisy measurements of the product x0 x1: all points of a hyperbola are optima.
  const VectorXd seen = VectorXd::Constant(10, 6.0) + 0.1 * random_matrix(10, 1, Rng(6));
  const Residuals product{2, 10, {}, [seen](ConstVectorRef x, VectorXd& r, MatrixXd* j) {
                            r = VectorXd::Constant(10, x[0] * x[1]) - seen;
                            if (j) *j << VectorXd::Constant(10, x[1]), VectorXd::Constant(10, x[0]);
                          }};
  LeastSquaresOptions endless{
      .max_iterations = 1000, .cost_tolerance = 0, .step_tolerance = 0, .gradient_tolerance = 0};
  const auto fit = least_squares(product, Eigen::Vector2d(2, 2.5), endless);
  EXPECT_NEAR(fit.x.prod(), seen.mean(), 1e-9);
  // The nearest point of the hyperbola is within 0.25 of the start.
  EXPECT_LT((fit.x - Eigen::Vector2d(2, 2.5)).norm(), 0.3);
}

TEST(LeastSquares, FewerRowsThanUnknownsIsSolvedByTheSmallestChange) {
  const MatrixXd a = random_matrix(3, 5, Rng(11));
  const VectorXd b = random_matrix(3, 1, Rng(12));
  const auto fit = least_squares(linear(a, b), VectorXd::Zero(5), {.scale = VectorXd::Ones(5)});
  EXPECT_LT((fit.x - solve_least_squares(a, b)).norm(), 1e-10);
}

TEST(Loss, IsTheSquareForSmallResidualsAndItsWeightIsItsDerivative) {
  for (const Loss loss : testing::losses) {
    EXPECT_NEAR(loss_value(loss, 1e-8, 2.0).rho, 1e-8, 1e-16) << int(loss);
    EXPECT_NEAR(loss_value(loss, 0.0, 2.0).weight, 1.0, 1e-15) << int(loss);
    for (const double s : {0.3, 3.9, 4.1, 50.0}) {
      const auto rho = [&](const VectorXd& x) { return VectorXd::Constant(1, loss_value(loss, x[0], 2.0).rho).eval(); };
      EXPECT_NEAR(loss_value(loss, s, 2.0).weight, numeric_jacobian(rho, VectorXd::Constant(1, s))(0, 0), 1e-8)
          << "loss " << int(loss) << " s " << s;
    }
  }
}

TEST(LeastSquares, GradientOfTheRobustCostIsTheWeightedJacobianTimesTheResiduals) {
  const Residuals problem = testing::planar_pose_with_outliers();
  for (const Loss loss : testing::losses) {
    const auto at = [&](const VectorXd& x) {
      return least_squares(problem, x, {.max_iterations = 0, .loss = loss, .loss_scale = 4.0});
    };
    const VectorXd x = Eigen::Vector3d(0.51, 1.02, 1.97);
    const auto cost = [&](const VectorXd& v) { return VectorXd::Constant(1, at(v).cost).eval(); };
    const auto here = at(x);
    VectorXd weights = VectorXd::Ones(problem.rows);
    for (Eigen::Index i = 0; i < 60; ++i) weights[i] = here.block_weights[i / 2];
    const VectorXd gradient = 2.0 * here.jacobian.transpose() * weights.asDiagonal() * here.residuals;
    EXPECT_LT((gradient - numeric_jacobian(cost, x).transpose()).norm(), 1e-6 * gradient.norm()) << int(loss);
  }
}

TEST(LeastSquares, RobustLossesFindTheLineDespiteOutliers) {
  const Residuals problem = testing::line_with_outliers();
  const Eigen::Vector2d truth(2, -1);
  const auto plain = least_squares(problem, Eigen::Vector2d(0, 0));
  EXPECT_GT((plain.x - truth).norm(), 0.4);  // a fifth of the samples is 3 too high
  for (const Loss loss : testing::losses) {
    if (loss == Loss::none) continue;
    const VectorXd start = loss == Loss::tukey ? VectorXd(Eigen::Vector2d(2.1, -0.9)) : VectorXd(Eigen::Vector2d(0, 0));
    const auto fit = least_squares(problem, start, {.loss = loss, .loss_scale = loss == Loss::tukey ? 5.0 : 3.0});
    EXPECT_TRUE(converged(fit.stop)) << name(fit.stop);
    // Standard deviation of the intercept from 32 good samples is 0.035; huber is biased by its bounded pull.
    EXPECT_LT((fit.x - truth).norm(), loss == Loss::huber ? 0.2 : 0.1) << int(loss);
    for (Eigen::Index i = 0; i < 40; ++i)
      EXPECT_EQ(fit.block_weights[i] < 0.2, i % 5 == 0) << "loss " << int(loss) << " sample " << i;
  }
}

TEST(LeastSquares, RowsAfterTheBlocksCarryNoLoss) {
  // Two measurements of x at 0 (robust) and a prior at 100: without a loss on the prior the optimum of huber is at 98.
  const Residuals problem{1, 3, {1, 1}, [](ConstVectorRef x, VectorXd& r, MatrixXd* j) {
                            r << x[0], x[0], x[0] - 100.0;
                            if (j) j->setOnes();
                          }};
  const auto fit = least_squares(problem, VectorXd::Zero(1), {.loss = Loss::huber, .loss_scale = 1.0});
  EXPECT_NEAR(fit.x[0], 98.0, 1e-7);  // 2 (x − 100) + 2 · 2 = 0
  EXPECT_EQ(fit.block_weights.size(), 2);
}

TEST(LeastSquares, TheSameCallGivesTheSameBitsOnAnyNumberOfThreads) {
  const Residuals problem = testing::planar_pose_with_outliers();
  const auto fit = [&] {
    return least_squares(problem, Eigen::Vector3d(0.3, 0.5, 1.5), {.loss = Loss::cauchy, .loss_scale = 3.0}).x;
  };
  const VectorXd once = fit();
  for (const int threads : {1, 2, 7}) {
    std::vector<VectorXd> found(14);
    parallel_for(found.size(), threads, [&](std::size_t i) { found[i] = fit(); });
    for (const VectorXd& x : found) EXPECT_EQ(x, once) << threads << " threads";
  }
}

TEST(LeastSquaresStop, ConvergedCostWhereTheCostNoLongerFalls) {
  const auto problem = testing::bard();
  const auto fit = least_squares(problem.residuals, problem.start, {.step_tolerance = 0, .gradient_tolerance = 0});
  EXPECT_EQ(fit.stop, Stop::converged_cost);
}

TEST(LeastSquaresStop, ConvergedStepWhereTheStepIsShort) {
  const auto problem = testing::bard();
  const auto fit = least_squares(problem.residuals, problem.start,
                                 {.cost_tolerance = 0, .step_tolerance = 1e-4, .gradient_tolerance = 0});
  EXPECT_EQ(fit.stop, Stop::converged_step);
}

TEST(LeastSquaresStop, ConvergedGradientAtTheOptimumItself) {
  const auto fit = least_squares(testing::rosenbrock().residuals, Eigen::Vector2d(1, 1));
  EXPECT_EQ(fit.stop, Stop::converged_gradient);
  EXPECT_EQ(fit.evaluations, 1);
  const Residuals two_rows = linear(Eigen::Vector2d(1, 1), Eigen::Vector2d(-1, 1));
  EXPECT_EQ(least_squares(two_rows, VectorXd::Zero(1)).stop, Stop::converged_gradient);
}

TEST(LeastSquaresStop, TargetReachedAsSoonAsTheCostIsLowEnough) {
  const auto problem = testing::wood();
  const auto fit = least_squares(problem.residuals, problem.start, {.target_cost = 1.0});
  EXPECT_EQ(fit.stop, Stop::target_reached);
  EXPECT_LE(fit.cost, 1.0);
  EXPECT_GT(fit.history[fit.history.size() - 2], 1.0);
}

TEST(LeastSquaresStop, BudgetSpentAfterAsManyIterationsAsAllowed) {
  const auto problem = testing::wood();
  const auto fit = least_squares(problem.residuals, problem.start, {.max_iterations = 3});
  EXPECT_EQ(fit.stop, Stop::budget_spent);
  EXPECT_EQ(fit.iterations, 3);
}

TEST(LeastSquaresStop, StalledWhereTheJacobianHasTheWrongSign) {
  const Residuals wrong = scalar([](double x) { return x; }, [](double) { return -1.0; });
  const auto fit = least_squares(wrong, unit_start);
  EXPECT_EQ(fit.stop, Stop::stalled);
  EXPECT_EQ(fit.x, unit_start);
}

TEST(LeastSquaresStop, NotFiniteWhereTheStartHasNoFiniteCostOrJacobian) {
  const Residuals logarithm = scalar([](double x) { return std::log(x); }, [](double x) { return 1 / x; });
  const Residuals root = scalar([](double x) { return std::sqrt(x) + 1; }, [](double x) { return 0.5 / std::sqrt(x); });
  for (const auto& [problem, start] : {std::pair{logarithm, -1.0}, std::pair{logarithm, 0.0}, std::pair{root, 0.0}}) {
    const auto fit = least_squares(problem, VectorXd::Constant(1, start));
    EXPECT_EQ(fit.stop, Stop::not_finite);
    EXPECT_EQ(fit.cost, infinite);
    EXPECT_EQ(fit.not_finite, 1);
    EXPECT_EQ(fit.x[0], start);
  }
  const Residuals infinite_row = scalar([](double) { return infinite; }, [](double) { return 1.0; });
  EXPECT_EQ(least_squares(infinite_row, unit_start, {.loss = Loss::tukey}).stop, Stop::not_finite);
}

TEST(LeastSquaresStop, CancelledWhenTheObserverRequestsIt) {
  const auto problem = testing::wood();
  std::vector<double> best;
  const auto fit = least_squares(problem.residuals, problem.start, {}, [&](const Progress& progress) {
    best.push_back(progress.best);
    return progress.iteration == 4 ? ObserverDecision::stop : ObserverDecision::proceed;
  });
  EXPECT_EQ(fit.stop, Stop::cancelled);
  EXPECT_EQ(fit.iterations, 4);
  EXPECT_EQ(best, fit.history);
}

TEST(LeastSquares, StepsOutOfTheDomainAreCountedAndShortened) {
  // log x = 0 from x = 5: the undamped step leads to 5 − 5 log 5 = −3.
  const Residuals logarithm = scalar([](double x) { return std::log(x); }, [](double x) { return 1 / x; });
  const auto fit = least_squares(logarithm, VectorXd::Constant(1, 5.0));
  EXPECT_TRUE(converged(fit.stop)) << name(fit.stop);
  EXPECT_NEAR(fit.x[0], 1.0, 1e-15);
  EXPECT_GT(fit.not_finite, 0);
}

TEST(LeastSquaresDeathTest, WrongShapesStopTheProgram) {
  const auto problem = testing::rosenbrock();
  EXPECT_DEATH(least_squares(problem.residuals, VectorXd::Zero(3)), "3 values for 2 unknowns");
  Residuals many_blocks = problem.residuals;
  many_blocks.blocks = {2, 1};
  EXPECT_DEATH(least_squares(many_blocks, problem.start), "3 rows in blocks, 2 in all");
}

}  // namespace
}  // namespace kinfer
