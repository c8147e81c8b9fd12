// SPDX-License-Identifier: Apache-2.0
// Block products for any processor: two doubles at a time, which every 64-bit processor supports.
#include "kinfer/linalg/kernels/block_kernel.hpp"

namespace kinfer::batch {

const BlockKernel portable_block{add_product<Pack<double, 2>>, solve_right<Pack<double, 2>>};

}  // namespace kinfer::batch
