// The movement of a swarm with AVX-512. Compiled for it (src/kinfer/CMakeLists.txt).
#include "kinfer/search/swarm_kernel.hpp"

namespace kinfer::search {

extern const SwarmKernel swarm_avx512 = move_particle;

}  // namespace kinfer::search
