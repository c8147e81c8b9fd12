// Draws with AVX2. Compiled for it (src/kinfer/CMakeLists.txt).
#include "kinfer/base/uniform_kernel.hpp"

namespace kinfer::base {

extern const UniformKernel uniform_avx2 = fill_uniform;

}  // namespace kinfer::base
