// SPDX-License-Identifier: Apache-2.0
// The batch kernels for AVX-512. Compiled with -mavx512f -mfma.
#include "kinfer/kinematics/batch/errors_kernel.hpp"
#include "kinfer/kinematics/batch/jacobian_kernel.hpp"
#include "kinfer/kinematics/batch/poses_kernel.hpp"

namespace kinfer::batch {

using Wide = Pack<double, 8>;
using Narrow = Pack<float, 16>;
extern const Kernels avx512_kernels{"AVX-512",
                                    8,
                                    16,
                                    population_sums<Wide, 4>,
                                    population_sums<Narrow, 4>,
                                    sines<Wide>,
                                    point_errors<Wide, 4>,
                                    jacobian<Wide>,
                                    poses<Wide>};

}  // namespace kinfer::batch
