// SPDX-License-Identifier: Apache-2.0
// Block products for AVX-512 (F). Compiled with -mavx512f -mfma.
#include "kinfer/linalg/kernels/block_kernel.hpp"

namespace kinfer::batch {

extern const BlockKernel avx512_block{add_product<Pack<double, 8>>, solve_right<Pack<double, 8>>};

}  // namespace kinfer::batch
