// Products of blocks for any processor: two numbers at a time, as every 64-bit one has them.
#include "kinfer/linalg/block_kernel.hpp"

namespace kinfer::batch {

const BlockKernel portable_block{add_product<Pack<double, 2>>, solve_right<Pack<double, 2>>};

}  // namespace kinfer::batch
