// SPDX-License-Identifier: Apache-2.0
#include "kinfer/linalg/block_products.hpp"

#include <gtest/gtest.h>

#include "kinfer/base/instruction_set.hpp"
#include "kinfer/linalg/kernels/block_jobs.hpp"
#include "support/random.hpp"

namespace kinfer {
namespace {

using Eigen::Index;

MatrixXd random_lower(Index size, std::uint64_t seed) {
  MatrixXd l = test::random_matrix(size, size, seed).triangularView<Eigen::Lower>();
  l.diagonal() = l.diagonal().cwiseAbs().array() + static_cast<double>(size);
  return l;
}

/// All instruction sets that this processor has.
std::vector<const batch::BlockKernel*> runnable() {
  std::vector<const batch::BlockKernel*> kernels{&batch::portable_block};
#if defined(__x86_64__)
  if (instruction_set() >= InstructionSet::avx2) kernels.push_back(&batch::avx2_block);
  if (instruction_set() >= InstructionSet::avx512) kernels.push_back(&batch::avx512_block);
#endif
  return kernels;
}

constexpr Index some_rows[] = {0, 1, 3, 7, 8, 9, 15, 16, 17, 24, 40, 101};

TEST(BlockProducts, EveryInstructionSetAddsTheProductAndTouchesNothingElse) {
  for (const batch::BlockKernel* kernel : runnable())
    for (const Index rows : some_rows)
      for (const Index columns : {1, 2, 5, 8, 23})
        for (const Index depth : {0, 1, 12, 64, 65, 200}) {
          const MatrixXd a = test::random_matrix(rows + 3, depth, 1), b = test::random_matrix(columns + 1, depth, 2);
          const MatrixXd before = test::random_matrix(rows + 2, columns + 1, 3);
          MatrixXd to = before, expected = before;
          expected.topLeftCorner(rows, columns) -= 0.5 * a.topRows(rows) * b.topRows(columns).transpose();
          kernel->add_product({.a = a.data(),
                               .a_stride = a.rows(),
                               .b = b.data(),
                               .b_stride = b.rows(),
                               .to = to.data(),
                               .to_stride = to.rows(),
                               .rows = static_cast<int>(rows),
                               .columns = static_cast<int>(columns),
                               .depth = static_cast<int>(depth),
                               .factor = -0.5});
          EXPECT_LT((to - expected).cwiseAbs().maxCoeff(), 1e-12) << rows << " " << columns << " " << depth;
          EXPECT_EQ(to.bottomRows(2), before.bottomRows(2));
          EXPECT_EQ(to.rightCols(1), before.rightCols(1));
        }
}

TEST(BlockProducts, TheLowerHalfOfASquareIsThatOfTheProduct) {
  for (const Index size : some_rows)
    for (const Index depth : {1, 12, 130}) {
      const MatrixXd a = test::random_matrix(size, depth, 4), before = test::random_matrix(size, size, 5);
      MatrixXd to = before;
      add_square(a, 2.0, to);
      const MatrixXd error = to - before - 2.0 * a * a.transpose();
      EXPECT_LT(MatrixXd(error.triangularView<Eigen::Lower>()).norm(), 1e-11) << size << " " << depth;
    }
}

TEST(BlockProducts, EveryInstructionSetSolvesForTheLeftFactorOfAProduct) {
  for (const batch::BlockKernel* kernel : runnable())
    for (const Index rows : some_rows)
      for (const Index columns : {1, 2, 8, 14, 76}) {
        const MatrixXd x = test::random_matrix(rows, columns, 6), l = random_lower(columns, 7);
        MatrixXd b = test::random_matrix(rows + 2, columns, 8);
        const MatrixXd below = b.bottomRows(2);
        b.topRows(rows) = x * l.transpose();
        kernel->solve_right({.l = l.data(),
                             .l_stride = l.rows(),
                             .b = b.data(),
                             .b_stride = b.rows(),
                             .rows = static_cast<int>(rows),
                             .columns = static_cast<int>(columns)});
        EXPECT_LT((b.topRows(rows) - x).cwiseAbs().sum(), 1e-12 * static_cast<double>(1 + x.size()));
        EXPECT_EQ(b.bottomRows(2), below);
      }
}

TEST(BlockProducts, WorkOnPartsOfMatrices) {
  const MatrixXd a = test::random_matrix(30, 20, 9), l = random_lower(9, 10);
  MatrixXd to = MatrixXd::Zero(30, 30), x = a;
  add_product(a.block(2, 3, 11, 7), a.block(5, 1, 6, 7), 1.0, to.block(1, 2, 11, 6));
  EXPECT_LT((to.block(1, 2, 11, 6) - a.block(2, 3, 11, 7) * a.block(5, 1, 6, 7).transpose()).norm(), 1e-12);
  solve_right(l.topLeftCorner(6, 6), x.block(4, 2, 13, 6));
  EXPECT_LT((x.block(4, 2, 13, 6) * l.topLeftCorner(6, 6).transpose() - a.block(4, 2, 13, 6)).norm(), 1e-12);
}

}  // namespace
}  // namespace kinfer
