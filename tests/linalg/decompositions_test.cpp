// SPDX-License-Identifier: Apache-2.0
#include "kinfer/linalg/decompositions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "support/random.hpp"

namespace kinfer {
namespace {

MatrixXd identity(Eigen::Index n) {
  return MatrixXd::Identity(n, n);
}

MatrixXd random_positive(Eigen::Index n, std::uint64_t seed) {
  const MatrixXd a = test::random_matrix(2 * n, n, seed);
  return a.transpose() * a;
}

bool descending(const VectorXd& s) {
  return std::is_sorted(s.data(), s.data() + s.size(), std::greater<>());
}

TEST(Svd, MultipliesBackWithOrthonormalFactorsAndFallingValues) {
  for (const auto& [rows, cols] : {std::pair{9, 4}, std::pair{4, 9}, std::pair{5, 5}, std::pair{1, 3}}) {
    const MatrixXd a = test::random_matrix(rows, cols, 1);
    const Svd found = svd(a);
    const Eigen::Index k = std::min(rows, cols);
    EXPECT_LT((found.u * found.s.asDiagonal() * found.v.transpose() - a).norm(), 1e-13);
    EXPECT_LT((found.u.transpose() * found.u - identity(k)).norm(), 1e-13);
    EXPECT_LT((found.v.transpose() * found.v - identity(k)).norm(), 1e-13);
    EXPECT_TRUE(descending(found.s));
  }
}

TEST(RightSvd, HasTheValuesOfTheWholeDecompositionAndZerosWhereRowsAreMissing) {
  for (const auto& [rows, cols] : {std::pair{200, 6}, std::pair{4, 9}, std::pair{5, 5}}) {
    const MatrixXd a = test::random_matrix(rows, cols, 2);
    const RightSvd found = right_svd(a);
    const VectorXd s = svd(a).s;
    ASSERT_EQ(found.s.size(), cols);
    EXPECT_LT((found.s.head(s.size()) - s).norm(), 1e-12);
    EXPECT_LT(found.s.tail(cols - s.size()).norm(), 1e-13);
    EXPECT_LT((found.v.transpose() * found.v - identity(cols)).norm(), 1e-13);
    for (Eigen::Index i = 0; i < cols; ++i) EXPECT_NEAR((a * found.v.col(i)).norm(), found.s[i], 1e-12);
  }
}

TEST(RightSvd, FindsTheNullDirection) {
  MatrixXd a = test::random_matrix(50, 3, 3);
  a.col(2) = a.col(0) - 2 * a.col(1);  // so (1, −2, −1) is the null direction
  const RightSvd found = right_svd(a);
  EXPECT_LT(found.s[2], 1e-14 * found.s[0]);
  EXPECT_NEAR(std::abs(found.v.col(2).dot(Eigen::Vector3d(1, -2, -1).normalized())), 1.0, 1e-14);
}

TEST(SymmetricEigen, OfARotatedDiagonalAreItsEntriesAscending) {
  const MatrixXd orthogonal = svd(test::random_matrix(4, 4, 4)).u;
  const MatrixXd a = orthogonal * Eigen::Vector4d(3, -1, 7, 0.5).asDiagonal() * orthogonal.transpose();
  const SymmetricEigen found = symmetric_eigen(a);
  EXPECT_LT((found.values - Eigen::Vector4d(-1, 0.5, 3, 7)).norm(), 1e-13);
  EXPECT_LT((a * found.vectors - found.vectors * found.values.asDiagonal()).norm(), 1e-13);
}

TEST(SymmetricEigen, ReadsTheLowerHalfOnly) {
  const MatrixXd a = random_positive(3, 5);
  MatrixXd lower = a;
  lower.triangularView<Eigen::StrictlyUpper>().setConstant(99);
  EXPECT_EQ(symmetric_eigen(lower).values, symmetric_eigen(a).values);
}

TEST(Positive, SolutionInverseAndFactorSatisfyTheirEquations) {
  const MatrixXd a = random_positive(6, 6);
  const VectorXd b = test::random_matrix(6, 1, 7);
  EXPECT_LT((a * *solve_spd(a, b) - b).norm(), 1e-12);
  EXPECT_LT((a * *invert_spd(a) - identity(6)).norm(), 1e-12);
  const MatrixXd l = *cholesky(a);
  EXPECT_LT((l * l.transpose() - a).norm(), 1e-13 * a.norm());
  EXPECT_EQ(MatrixXd(l.triangularView<Eigen::StrictlyUpper>()).norm(), 0.0);
}

TEST(Positive, AnIndefiniteMatrixHasNoSolution) {
  const MatrixXd a = Eigen::Vector3d(1, -1, 2).asDiagonal();
  EXPECT_FALSE(solve_spd(a, VectorXd::Ones(3)).has_value());
  EXPECT_FALSE(invert_spd(a).has_value());
  EXPECT_FALSE(cholesky(a).has_value());
}

/// Of rank one but for the smallest part, in units that differ by 1e20.
TEST(Positive, WhatRoundingMadeIndefiniteHasAFactorAndAnInverse) {
  const MatrixXd sound = random_positive(5, 9);
  EXPECT_EQ(invert_but_for_rounding(sound), *invert_spd(sound));
  EXPECT_EQ(cholesky_but_for_rounding(sound), *cholesky(sound));
  const VectorXd big = 1e10 * test::random_matrix(4, 1, 3);
  MatrixXd a = big * big.transpose();
  a(3, 3) -= 1e5;
  ASSERT_FALSE(cholesky(a).has_value());
  const MatrixXd root = cholesky_but_for_rounding(a), inverse = invert_but_for_rounding(a);
  EXPECT_LT((root * root.transpose() - a).norm(), 1e-12 * a.norm());
  EXPECT_LT((inverse * root * root.transpose() - identity(4)).norm(), 0.1);
  const MatrixXd indefinite = Eigen::Vector3d(1.0, -1.0, 0.0).asDiagonal();
  EXPECT_TRUE(cholesky_but_for_rounding(indefinite).allFinite());
  MatrixXd no_diagonal = MatrixXd::Constant(2, 2, 1e10);
  no_diagonal.diagonal() << 0.0, 1e-300;
  EXPECT_TRUE(invert_but_for_rounding(no_diagonal).allFinite()) << "and ends";
}

TEST(Positive, SemidefiniteSystemsAreSolvedInTheirRange) {
  MatrixXd half = test::random_matrix(6, 6, 8);
  half.row(3).setZero();  // a direction without variance
  const MatrixXd a = half * half.transpose(), b = a * test::random_matrix(6, 2, 9);
  EXPECT_LT((a * solve_semidefinite(a, b) - b).norm(), 1e-10);
}

TEST(SolveLeastSquares, LeavesAResidualOrthogonalToTheColumns) {
  const MatrixXd a = test::random_matrix(20, 5, 8);
  const VectorXd b = test::random_matrix(20, 1, 9);
  EXPECT_LT((a.transpose() * (a * solve_least_squares(a, b) - b)).norm(), 1e-12);
}

TEST(SolveLeastSquares, OfAllSolutionsTakesTheShortest) {
  // x + y = 2 and again 2 x + 2 y = 4
  const MatrixXd a = (MatrixXd(2, 2) << 1, 1, 2, 2).finished();
  EXPECT_LT((solve_least_squares(a, Eigen::Vector2d(2, 4)) - Eigen::Vector2d(1, 1)).norm(), 1e-14);
}

TEST(SolveLeastSquares, ThresholdDecidesWhatCountsAsZero) {
  const MatrixXd a = Eigen::Vector2d(1, 1e-6).asDiagonal();
  EXPECT_NEAR(solve_least_squares(a, Eigen::Vector2d(1, 1))[1], 1e6, 1e-6);
  EXPECT_EQ(solve_least_squares(a, Eigen::Vector2d(1, 1), 1e-5)[1], 0.0);
}

TEST(TriangularFactor, HasTheSameInnerProductsAndZerosBelow) {
  for (const auto& [rows, cols] : {std::pair{30, 5}, std::pair{3, 5}}) {
    const MatrixXd a = test::random_matrix(rows, cols, 10), r = triangular_factor(a);
    EXPECT_EQ(r.rows(), std::min(rows, cols));
    EXPECT_LT((r.transpose() * r - a.transpose() * a).norm(), 1e-12);
    EXPECT_EQ(MatrixXd(r.triangularView<Eigen::StrictlyLower>()).norm(), 0.0);
  }
}

}  // namespace
}  // namespace kinfer
