// SPDX-License-Identifier: Apache-2.0
// Dense solvers where a matrix is small, empty, singular, or not what it should be.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "kinfer/linalg/block_products.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/linalg/normal_equations.hpp"
#include "kinfer/linalg/small_cholesky.hpp"
#include "support/random.hpp"

namespace kinfer {
namespace {

using test::random_matrix;

MatrixXd positive_matrix(Eigen::Index n, std::uint64_t seed) {
  const MatrixXd a = random_matrix(n + 2, n, seed);
  return a.transpose() * a;
}

TEST(SmallCholesky, IsTheFactorOfTheLargeOneWithTheUpperHalfCleared) {
  for (const Eigen::Index n : {1, 2, 3, 7, 12}) {
    const MatrixXd a = positive_matrix(n, 3);
    MatrixXd factor = a;
    ASSERT_TRUE(factorise_small(factor));
    EXPECT_LT((factor * factor.transpose() - a).norm(), 1e-13 * a.norm());
    EXPECT_LT((factor - *cholesky(a)).norm(), 1e-13 * factor.norm());
    EXPECT_EQ(MatrixXd(factor.triangularView<Eigen::StrictlyUpper>()).norm(), 0.0);
  }
}

TEST(SmallCholesky, ReadsTheLowerHalfOnly) {
  const MatrixXd a = positive_matrix(4, 5);
  MatrixXd clean = a, dirty = a;
  dirty.triangularView<Eigen::StrictlyUpper>().setConstant(1e300);
  ASSERT_TRUE(factorise_small(clean) && factorise_small(dirty));
  EXPECT_EQ(clean, dirty);
}

TEST(SmallCholesky, RefusesWhatIsNotPositiveDefinite) {
  MatrixXd singular = MatrixXd::Ones(2, 2), negative = -MatrixXd::Identity(3, 3), zero = MatrixXd::Zero(1, 1);
  MatrixXd unknown = MatrixXd::Identity(2, 2);
  unknown(1, 1) = std::numeric_limits<double>::quiet_NaN();
  for (MatrixXd* a : {&singular, &negative, &zero, &unknown}) EXPECT_FALSE(factorise_small(*a));
}

TEST(DampedByEigenvalues, GivesTheStepOfTheSingularValues) {
  for (const double damping : {0.0, 1e-6, 0.3, 100.0}) {
    const MatrixXd a = random_matrix(20, 6, 1);
    const VectorXd b = random_matrix(20, 1, 2);
    const VectorXd by_svd = solve_damped_by_svd(singular_system(a, b), damping);
    EXPECT_LT((solve_damped_by_eigenvalues(normal_equations(a, b), damping) - by_svd).norm(), 1e-12);
    EXPECT_LT((*solve_damped_by_cholesky(normal_equations(a, b), damping) - by_svd).norm(), 1e-12);
  }
}

TEST(DampedByEigenvalues, DoesNotMoveAlongADirectionThatNothingSees) {
  MatrixXd a = random_matrix(20, 4, 1);
  a.col(3) = a.col(0) + a.col(1);  // (1, 1, 0, -1) has no effect
  const VectorXd b = random_matrix(20, 1, 2), unseen = (VectorXd(4) << 1, 1, 0, -1).finished();
  for (const double damping : {0.0, 1e-9, 1.0}) {
    const VectorXd x = solve_damped_by_eigenvalues(normal_equations(a, b), damping);
    EXPECT_NEAR(x.dot(unseen), 0.0, 1e-7) << damping;
    EXPECT_LT((x - solve_damped_by_svd(singular_system(a, b), damping)).norm(), 1e-7) << damping;
  }
  EXPECT_FALSE(solve_damped_by_cholesky(normal_equations(a, b), 0.0));
}

TEST(SingularSystemOf, HoldsTheValuesAndTheImageOfTheRightSide) {
  const MatrixXd a = random_matrix(9, 3, 4);
  const VectorXd b = random_matrix(9, 1, 5);
  const SingularSystem system = singular_system(a, b);
  EXPECT_LT((system.s - svd(a).s).norm(), 1e-13);
  EXPECT_LT((system.v * (system.s.asDiagonal() * system.image) - a.transpose() * b).norm(), 1e-12);  // aᵀ b = v s uᵀ b
  EXPECT_DEATH(singular_system(a, b.head(4)), "9 rows, 4 values");
}

TEST(NormalEquationsOf, NothingAreZero) {
  const NormalEquations none = normal_equations(MatrixXd(0, 3), VectorXd(0));
  EXPECT_EQ(none.matrix, MatrixXd::Zero(3, 3));
  EXPECT_EQ(none.gradient, VectorXd::Zero(3));
  EXPECT_EQ(normal_equations(MatrixXd(4, 0), VectorXd::Ones(4)).matrix.size(), 0);
  EXPECT_DEATH(normal_equations(MatrixXd::Zero(2, 1), VectorXd::Zero(3)), "2 rows, 3 values");
}

TEST(Decompositions, OfOneNumberAreTheNumberItself) {
  const MatrixXd one = MatrixXd::Constant(1, 1, -4.0), four = MatrixXd::Constant(1, 1, 4.0);
  EXPECT_EQ(svd(one).s[0], 4.0);
  EXPECT_EQ(right_svd(one).s[0], 4.0);
  EXPECT_EQ(symmetric_eigen(one).values[0], -4.0);
  EXPECT_EQ((*cholesky(four))(0, 0), 2.0);
  EXPECT_EQ((*invert_spd(four))(0, 0), 0.25);
  EXPECT_EQ((*solve_spd(four, VectorXd::Constant(1, 2.0)))[0], 0.5);
  EXPECT_EQ(std::abs(triangular_factor(one)(0, 0)), 4.0);
}

TEST(Decompositions, OfZerosHaveNoDirections) {
  const MatrixXd zero = MatrixXd::Zero(5, 3);
  EXPECT_EQ(svd(zero).s, VectorXd::Zero(3));
  EXPECT_EQ(right_svd(zero).s, VectorXd::Zero(3));
  EXPECT_TRUE(right_svd(zero).v.isUnitary());
  EXPECT_EQ(solve_least_squares(zero, VectorXd::Ones(5)), VectorXd::Zero(3));
  EXPECT_EQ(triangular_factor(zero), MatrixXd::Zero(3, 3));
}

TEST(Decompositions, OfEqualEigenvaluesHaveOrthonormalVectors) {
  const SymmetricEigen eigen = symmetric_eigen(7.0 * MatrixXd::Identity(4, 4));
  EXPECT_LT((eigen.values.array() - 7.0).matrix().norm(), 1e-14);
  EXPECT_TRUE(eigen.vectors.isUnitary());
}

TEST(Decompositions, OfAWideMatrixHaveAsManyRowsAsItHas) {
  const MatrixXd wide = random_matrix(2, 5, 6), r = triangular_factor(wide);
  EXPECT_EQ(r.rows(), 2);
  EXPECT_LT((r.transpose() * r - wide.transpose() * wide).norm(), 1e-13);
  EXPECT_EQ(r(1, 0), 0.0);
  EXPECT_EQ(svd(wide).s.size(), 2);
  EXPECT_EQ(right_svd(wide).v.cols(), 5);
}

TEST(SolveSix, GivesWhatLeastSquaresDoAndLeavesTheRestAsItIs) {
  const Eigen::Matrix<double, 6, 6> a = positive_matrix(6, 9), none = -a;
  const Eigen::Matrix<double, 6, 1> b = random_matrix(6, 1, 10);
  Eigen::Matrix<double, 6, 1> x = b, same = b;
  ASSERT_TRUE(solve_six(a, x));
  EXPECT_LT((x - *solve_spd(a, b)).norm(), 1e-12 * x.norm());
  EXPECT_FALSE(solve_six(none, same));
  EXPECT_EQ(same, b);
}

TEST(Decompositions, InverseOfAnIllConditionedMatrixIsSymmetric) {
  MatrixXd a = positive_matrix(6, 8);
  a.row(0) *= 1e4, a.col(0) *= 1e4;
  const auto inverse = invert_spd(a);
  ASSERT_TRUE(inverse);
  EXPECT_LT((*inverse - inverse->transpose()).norm(), 1e-12 * inverse->norm());
  EXPECT_LT((*inverse * a - MatrixXd::Identity(6, 6)).norm(), 1e-6);
}

TEST(BlockProductsOf, NothingChangeNothing) {
  MatrixXd to = random_matrix(3, 3, 1);
  const MatrixXd before = to;
  add_product(MatrixXd(3, 0), MatrixXd(3, 0), 2.0, to);
  add_square(MatrixXd(3, 0), -1.0, to);
  EXPECT_EQ(to, before);
  MatrixXd empty(0, 3);
  solve_right(MatrixXd::Identity(3, 3), empty);
  EXPECT_EQ(empty.size(), 0);
}

}  // namespace
}  // namespace kinfer
