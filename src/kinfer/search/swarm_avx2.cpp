// The movement of a swarm with AVX2. Compiled for it (src/kinfer/CMakeLists.txt).
#include "kinfer/search/swarm_kernel.hpp"

namespace kinfer::search {

extern const SwarmKernel swarm_avx2 = move_particle;

}  // namespace kinfer::search
