// Products and triangular solves of dense blocks: what kernels and their callers share, in plain numbers.
#pragma once

#include <cstddef>

namespace kinfer::batch {

/// to += factor · a bᵀ; all column by column, columns so many numbers apart.
struct ProductJob {
  const double* a = nullptr;  ///< rows x depth
  std::ptrdiff_t a_stride = 0;
  const double* b = nullptr;  ///< columns x depth
  std::ptrdiff_t b_stride = 0;
  double* to = nullptr;  ///< rows x columns
  std::ptrdiff_t to_stride = 0;
  int rows = 0, columns = 0, depth = 0;
  double factor = 1.0;
  bool lower = false;  ///< only what stands on and below the diagonal counts; some of what is above is lost
};

/// x of x lᵀ = b in place of b.
struct SolveJob {
  const double* l = nullptr;  ///< columns x columns, lower triangular
  std::ptrdiff_t l_stride = 0;
  double* b = nullptr;  ///< rows x columns
  std::ptrdiff_t b_stride = 0;
  int rows = 0, columns = 0;
};

/// What a kernel file offers.
struct BlockKernel {
  void (*add_product)(const ProductJob&) = nullptr;
  void (*solve_right)(const SolveJob&) = nullptr;
};
extern const BlockKernel portable_block;
#if defined(__x86_64__)
extern const BlockKernel avx2_block, avx512_block;
#endif

}  // namespace kinfer::batch
