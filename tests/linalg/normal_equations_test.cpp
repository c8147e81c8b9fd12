// SPDX-License-Identifier: Apache-2.0
#include "kinfer/linalg/normal_equations.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kinfer/base/aligned_buffer.hpp"
#include "kinfer/base/instruction_set.hpp"
#include "kinfer/base/rng.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/linalg/kernels/gram_jobs.hpp"

namespace kinfer {
namespace {

MatrixXd random_rows(Eigen::Index rows, Eigen::Index cols, std::uint64_t seed) {
  Rng rng(seed);
  return MatrixXd::NullaryExpr(rows, cols, [&] { return rng.normal(); });
}

/// The same minimum from the stacked system [a; √damping I] x = −[b; 0], solved by singular values.
VectorXd slow_damped(const MatrixXd& a, const VectorXd& b, double damping) {
  MatrixXd stacked(a.rows() + a.cols(), a.cols());
  stacked << a, std::sqrt(damping) * MatrixXd::Identity(a.cols(), a.cols());
  VectorXd right = VectorXd::Zero(stacked.rows());
  right.head(b.size()) = -b;
  return solve_least_squares(stacked, right, 1e-15);
}

TEST(NormalEquations, AreTheInnerProductsTermByTerm) {
  for (const Eigen::Index rows : {1, 5, 301}) {
    for (const Eigen::Index cols : {1, 2, 7, 34}) {
      const MatrixXd a = random_rows(rows, cols, 1);
      const VectorXd b = random_rows(rows, 1, 2);
      const NormalEquations found = normal_equations(a, b);
      for (Eigen::Index i = 0; i < cols; ++i) {
        EXPECT_NEAR(found.gradient[i], a.col(i).dot(b), 1e-12);
        for (Eigen::Index j = 0; j < cols; ++j)
          EXPECT_NEAR(found.matrix(i, j), j <= i ? a.col(i).dot(a.col(j)) : 0.0, 1e-12) << rows << " " << cols;
      }
    }
  }
}

/// All instruction sets that this processor has.
std::vector<const batch::GramKernel*> runnable_grams() {
  std::vector<const batch::GramKernel*> kernels{&batch::portable_gram};
#if defined(__x86_64__)
  if (instruction_set() >= InstructionSet::avx2) kernels.push_back(&batch::avx2_gram);
  if (instruction_set() >= InstructionSet::avx512) kernels.push_back(&batch::avx512_gram);
#endif
  return kernels;
}

TEST(NormalEquations, EveryInstructionSetMakesTheSameFromAnyNumberOfChunks) {
  for (const batch::GramKernel* kernel : runnable_grams())
    for (const int rows : {1, 95, 96, 97, 384, 385, 1000})
      for (const int columns : {1, 4, 11, 12, 13, 50}) {
        const MatrixXd above = random_rows(rows + 3, columns, 7);  // column stride larger than the number of rows
        const VectorXd b = random_rows(rows, 1, 8);
        MatrixXd matrix = MatrixXd::Zero(columns, columns);
        VectorXd gradient(columns);
        batch::AlignedBuffer<double> workspace(batch::gram_workspace(rows, columns, kernel->lanes));
        kernel->normal_equations({.a = above.data(),
                                  .a_stride = above.outerStride(),
                                  .b = b.data(),
                                  .rows = rows,
                                  .columns = columns,
                                  .matrix = matrix.data(),
                                  .gradient = gradient.data(),
                                  .workspace = workspace.data()});
        const MatrixXd a = above.topRows(rows);
        const MatrixXd lower = (a.transpose() * a).triangularView<Eigen::Lower>();
        EXPECT_LT((matrix - lower).cwiseAbs().maxCoeff(), 1e-12 * (rows + 10)) << kernel->lanes << " " << rows;
        EXPECT_LT((gradient - a.transpose() * b).cwiseAbs().maxCoeff(), 1e-12 * (rows + 10));
      }
}

TEST(NormalEquations, BothWaysGiveTheMinimumOfTheDampedSquares) {
  for (const Eigen::Index rows : {4, 6, 50}) {
    const MatrixXd a = random_rows(rows, 6, 3);
    const VectorXd b = random_rows(rows, 1, 4);
    for (const double damping : {1e-3, 1.0, 1e6}) {
      const VectorXd slow = slow_damped(a, b, damping);
      const auto quick = solve_damped_by_cholesky(normal_equations(a, b), damping);
      ASSERT_TRUE(quick.has_value()) << rows << " rows, damping " << damping;
      EXPECT_LT((*quick - slow).norm(), 1e-9 * slow.norm());
      EXPECT_LT((solve_damped_by_svd(singular_system(a, b), damping) - slow).norm(), 1e-11 * slow.norm());
    }
  }
}

TEST(NormalEquations, CholeskyRefusesARankDeficientSystemAndSvdDoesNotMoveAlongItsNullSpace) {
  MatrixXd a = random_rows(60, 4, 5);
  a.col(3) = a.col(0) + a.col(1);
  const VectorXd b = random_rows(60, 1, 6);
  EXPECT_FALSE(solve_damped_by_cholesky(normal_equations(a, b), 1e-14).has_value());
  const VectorXd shortest = solve_least_squares(a, -b, 1e-10);
  EXPECT_LT((solve_damped_by_svd(singular_system(a, b), 1e-14) - shortest).norm(), 1e-10);
}

TEST(CovarianceOfNormalMatrix, IsTheInverseWhateverTheScales) {
  Rng rng(3);
  MatrixXd a(40, 6);
  for (double& value : a.reshaped()) value = rng.normal();
  VectorXd scale(6);
  scale << 1.0, 1e-6, 1e5, 1.0, 1e-3, 1e3;
  a = a * scale.asDiagonal();
  const MatrixXd normal = a.transpose() * a;
  const MatrixXd identity = covariance_of_normal_matrix(normal) * normal;
  EXPECT_LT((scale.asDiagonal() * identity * scale.cwiseInverse().asDiagonal() - MatrixXd::Identity(6, 6)).norm(),
            1e-9);
}

TEST(CovarianceOfNormalMatrix, ADirectionThatRoundingHidesHasALargeVarianceAndTheOthersTheirs) {
  // Two columns that differ by a weak prior only, and one of its own.
  MatrixXd normal = MatrixXd::Constant(3, 3, 1e12);
  normal(2, 0) = normal(2, 1) = normal(0, 2) = normal(1, 2) = 0.0;
  normal(2, 2) = 4.0;
  normal(0, 0) += 1e-8, normal(1, 1) += 1e-8;
  const MatrixXd covariance = covariance_of_normal_matrix(normal);
  EXPECT_NEAR(covariance(2, 2), 0.25, 1e-12);
  EXPECT_NEAR(covariance(0, 0) + 2.0 * covariance(0, 1) + covariance(1, 1), 1e-12, 1e-14) << "their sum is determined";
  EXPECT_GT(covariance(0, 0) - 2.0 * covariance(0, 1) + covariance(1, 1), 1.0) << "their difference is not";
}

TEST(CovarianceOfNormalMatrix, AnUnknownThatAppearsNowhereLeavesTheOthersAsTheyAre) {
  MatrixXd normal = MatrixXd::Zero(3, 3);
  normal(0, 0) = 4.0, normal(2, 2) = 5.0, normal(0, 2) = normal(2, 0) = 1.0;
  const MatrixXd covariance = covariance_of_normal_matrix(normal);
  EXPECT_TRUE(covariance.allFinite()) << covariance;
  EXPECT_NEAR(covariance(0, 0), 5.0 / 19.0, 1e-12);
  EXPECT_NEAR(covariance(0, 2), -1.0 / 19.0, 1e-12);
  EXPECT_GT(covariance(1, 1), 1e12);
}

}  // namespace
}  // namespace kinfer
