// SPDX-License-Identifier: Apache-2.0
// Block products for AVX2 with fused multiply-adds. Compiled with -mavx2 -mfma.
#include "kinfer/linalg/kernels/block_kernel.hpp"

namespace kinfer::batch {

extern const BlockKernel avx2_block{add_product<Pack<double, 4>>, solve_right<Pack<double, 4>>};

}  // namespace kinfer::batch
