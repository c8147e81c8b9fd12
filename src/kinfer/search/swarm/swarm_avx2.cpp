// SPDX-License-Identifier: Apache-2.0
// Particle update with AVX2 (compile options: src/kinfer/CMakeLists.txt).
#include "kinfer/search/swarm/swarm_kernel.hpp"

namespace kinfer::search {

extern const SwarmKernel swarm_avx2 = move_particle;

}  // namespace kinfer::search
