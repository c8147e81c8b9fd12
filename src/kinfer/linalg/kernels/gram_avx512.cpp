// SPDX-License-Identifier: Apache-2.0
// Normal equations for AVX-512. Compiled with -mavx512f -mfma.
#include "kinfer/linalg/kernels/gram_kernel.hpp"

namespace kinfer::batch {

extern const GramKernel avx512_gram{8, normal_equations<Pack<double, 8>>};

}  // namespace kinfer::batch
