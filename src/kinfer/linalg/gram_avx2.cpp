// Normal equations for AVX2 with fused multiply-adds. Compiled with -mavx2 -mfma.
#include "kinfer/linalg/gram_kernel.hpp"

namespace kinfer::batch {

extern const GramKernel avx2_gram{4, normal_equations<Pack<double, 4>>};

}  // namespace kinfer::batch
