// SPDX-License-Identifier: Apache-2.0
// Uniform random numbers with AVX-512 (compile options: src/kinfer/CMakeLists.txt).
#include "kinfer/base/uniform_kernel.hpp"

namespace kinfer::base {

extern const UniformKernel uniform_avx512 = fill_uniform;

}  // namespace kinfer::base
