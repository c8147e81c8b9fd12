// SPDX-License-Identifier: Apache-2.0
// Products and triangular solves of dense blocks: plain structs shared by the kernels and their callers.
#pragma once

#include <cstddef>

namespace kinfer::batch {

/// to += factor · a bᵀ; all column-major, columns a stride apart.
struct ProductJob {
  const double* a = nullptr;  ///< rows x depth
  std::ptrdiff_t a_stride = 0;
  const double* b = nullptr;  ///< columns x depth
  std::ptrdiff_t b_stride = 0;
  double* to = nullptr;  ///< rows x columns
  std::ptrdiff_t to_stride = 0;
  int rows = 0, columns = 0, depth = 0;
  double factor = 1.0;
  bool lower = false;  ///< only the lower triangle is computed; entries above it may be overwritten
};

/// Solves x lᵀ = b; x replaces b.
struct SolveJob {
  const double* l = nullptr;  ///< columns x columns, lower triangular
  std::ptrdiff_t l_stride = 0;
  double* b = nullptr;  ///< rows x columns
  std::ptrdiff_t b_stride = 0;
  int rows = 0, columns = 0;
};

/// The functions of one kernel file.
struct BlockKernel {
  void (*add_product)(const ProductJob&) = nullptr;
  void (*solve_right)(const SolveJob&) = nullptr;
};
extern const BlockKernel portable_block;
#if defined(__x86_64__)
extern const BlockKernel avx2_block, avx512_block;
#endif

}  // namespace kinfer::batch
