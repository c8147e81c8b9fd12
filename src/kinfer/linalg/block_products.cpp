// SPDX-License-Identifier: Apache-2.0
#include "kinfer/linalg/block_products.hpp"

#include "kinfer/base/expect.hpp"
#include "kinfer/base/instruction_set.hpp"
#include "kinfer/linalg/kernels/block_jobs.hpp"

namespace kinfer {
namespace {

const batch::BlockKernel& kernel() {
#if defined(__x86_64__)
  if (instruction_set() == InstructionSet::avx512) return batch::avx512_block;
  if (instruction_set() == InstructionSet::avx2) return batch::avx2_block;
#endif
  return batch::portable_block;
}

batch::ProductJob product(ConstMatrixRef a, ConstMatrixRef b, double factor, MatrixRef& to) {
  return {.a = a.data(),
          .a_stride = a.outerStride(),
          .b = b.data(),
          .b_stride = b.outerStride(),
          .to = to.data(),
          .to_stride = to.outerStride(),
          .rows = static_cast<int>(a.rows()),
          .columns = static_cast<int>(b.rows()),
          .depth = static_cast<int>(a.cols()),
          .factor = factor};
}

}  // namespace

void add_product(ConstMatrixRef a, ConstMatrixRef b, double factor, MatrixRef to) {
  KINFER_EXPECT(a.cols() == b.cols() && to.rows() == a.rows() && to.cols() == b.rows());
  kernel().add_product(product(a, b, factor, to));
}

void add_square(ConstMatrixRef a, double factor, MatrixRef to) {
  KINFER_EXPECT(to.rows() == a.rows() && to.cols() == a.rows());
  batch::ProductJob job = product(a, a, factor, to);
  job.lower = true;
  kernel().add_product(job);
}

void solve_right(ConstMatrixRef l, MatrixRef b) {
  KINFER_EXPECT(l.rows() == b.cols() && l.cols() == b.cols());
  kernel().solve_right({.l = l.data(),
                        .l_stride = l.outerStride(),
                        .b = b.data(),
                        .b_stride = b.outerStride(),
                        .rows = static_cast<int>(b.rows()),
                        .columns = static_cast<int>(b.cols())});
}

}  // namespace kinfer
