// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "kinfer/search/least_squares/least_squares.hpp"

namespace kinfer {
namespace {

/// The same problem, given by its normal equations only.
NormalProblem by_normal_equations(const Residuals& problem) {
  const auto evaluate = [&problem](ConstVectorRef x, MatrixXd* jacobian) {
    VectorXd r(problem.rows);
    if (jacobian) jacobian->resize(problem.rows, problem.unknowns);
    problem.evaluate(x, r, jacobian);
    return r;
  };
  NormalProblem normal;
  normal.unknowns = problem.unknowns;
  normal.cost = [evaluate](ConstVectorRef x) { return evaluate(x, nullptr).squaredNorm(); };
  normal.linearise = [evaluate](ConstVectorRef x, NormalEquations& equations) {
    MatrixXd jacobian;
    const VectorXd r = evaluate(x, &jacobian);
    equations = normal_equations(jacobian, r);
    return r.squaredNorm();
  };
  return normal;
}

/// r = [10 (y − x²), 1 − x]
Residuals rosenbrock() {
  Residuals problem{.unknowns = 2, .rows = 2};
  problem.evaluate = [](ConstVectorRef x, VectorXd& r, MatrixXd* jacobian) {
    r << 10.0 * (x[1] - x[0] * x[0]), 1.0 - x[0];
    if (jacobian) *jacobian << -20.0 * x[0], 10.0, -1.0, 0.0;
  };
  return problem;
}

TEST(NormalLeastSquares, TakesTheStepsThatTheJacobianWouldTake) {
  const Residuals problem = rosenbrock();
  const VectorXd start = Eigen::Vector2d(-1.2, 1.0);
  const LeastSquaresOutcome dense = least_squares(problem, start),
                            normal = least_squares(by_normal_equations(problem), start);
  EXPECT_LT((normal.x - Eigen::Vector2d::Ones()).norm(), 1e-8);
  EXPECT_NEAR(normal.iterations, dense.iterations, 1);
  EXPECT_LT(normal.jacobians, normal.evaluations);
}

TEST(NormalLeastSquares, MakesNoEquationsWhereTheTargetCostEndsTheSearch) {
  const Residuals dense = rosenbrock();
  const NormalProblem problem = by_normal_equations(dense);
  const VectorXd start = Eigen::Vector2d(-1.2, 1.0);
  const LeastSquaresOutcome found = least_squares(problem, start, {.target_cost = 1e-6}),
                            longer = least_squares(problem, start);
  EXPECT_EQ(found.stop, Stop::target_reached);
  EXPECT_LE(found.cost, 1e-6);
  EXPECT_EQ(found.normal.matrix.size(), 0);
  EXPECT_EQ(found.cost, longer.history[found.iterations]);
  EXPECT_GT(longer.normal.matrix.size(), 0);
}

TEST(NormalLeastSquares, AnUnobservableDirectionStaysAtItsStart) {
  Residuals problem{.unknowns = 3, .rows = 2};
  problem.evaluate = [](ConstVectorRef x, VectorXd& r, MatrixXd* jacobian) {
    r << x[0] + x[1] - 3.0, 1e-3 * (x[0] + x[1] - 3.0) + x[2];
    if (jacobian) *jacobian << 1.0, 1.0, 0.0, 1e-3, 1e-3, 1.0;
  };
  const LeastSquaresOutcome found = least_squares(by_normal_equations(problem), Eigen::Vector3d(1.0, 0.0, 5.0));
  EXPECT_LT(found.cost, 1e-20);
  EXPECT_NEAR(found.x[0] - found.x[1], 1.0, 1e-9);
}

TEST(LeastSquares, AnUnknownWhoseColumnIsRoundingStaysAtItsStart) {
  Residuals problem{.unknowns = 2, .rows = 2};
  problem.evaluate = [](ConstVectorRef x, VectorXd& r, MatrixXd* jacobian) {
    r << x[0] - 1.0, 1.0 + 1e-16 * x[1];
    if (jacobian) *jacobian << 1.0, 0.0, 0.0, 1e-16;
  };
  for (const LeastSquaresOutcome& found : {least_squares(problem, Eigen::Vector2d(0.0, 0.5)),
                                           least_squares(by_normal_equations(problem), Eigen::Vector2d(0.0, 0.5))}) {
    EXPECT_NEAR(found.x[0], 1.0, 1e-9);
    EXPECT_NEAR(found.x[1], 0.5, 1e-6);
  }
}

TEST(NormalLeastSquares, ANonFiniteCostAtTheStartIsReported) {
  NormalProblem problem{.unknowns = 1};
  problem.cost = [](ConstVectorRef) { return std::nan(""); };
  problem.linearise = [](ConstVectorRef, NormalEquations& normal) {
    normal = {MatrixXd::Ones(1, 1), VectorXd::Ones(1)};
    return std::nan("");
  };
  EXPECT_EQ(least_squares(problem, VectorXd::Zero(1)).stop, Stop::not_finite);
}

}  // namespace
}  // namespace kinfer
