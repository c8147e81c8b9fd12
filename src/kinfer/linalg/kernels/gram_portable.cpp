// SPDX-License-Identifier: Apache-2.0
// Normal equations for any processor: two doubles at a time, which every 64-bit processor supports.
#include "kinfer/linalg/kernels/gram_kernel.hpp"

namespace kinfer::batch {

const GramKernel portable_gram{2, normal_equations<Pack<double, 2>>};

}  // namespace kinfer::batch
