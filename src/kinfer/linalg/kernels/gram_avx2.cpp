// SPDX-License-Identifier: Apache-2.0
// Normal equations for AVX2 with fused multiply-adds. Compiled with -mavx2 -mfma.
#include "kinfer/linalg/kernels/gram_kernel.hpp"

namespace kinfer::batch {

extern const GramKernel avx2_gram{4, normal_equations<Pack<double, 4>>};

}  // namespace kinfer::batch
