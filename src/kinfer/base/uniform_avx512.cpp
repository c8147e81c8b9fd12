// Draws with AVX-512. Compiled for it (src/kinfer/CMakeLists.txt).
#include "kinfer/base/uniform_kernel.hpp"

namespace kinfer::base {

extern const UniformKernel uniform_avx512 = fill_uniform;

}  // namespace kinfer::base
