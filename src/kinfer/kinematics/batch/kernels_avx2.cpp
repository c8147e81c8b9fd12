// SPDX-License-Identifier: Apache-2.0
// The batch kernels for AVX2 with fused multiply-adds. Compiled with -mavx2 -mfma.
#include "kinfer/kinematics/batch/errors_kernel.hpp"
#include "kinfer/kinematics/batch/jacobian_kernel.hpp"
#include "kinfer/kinematics/batch/poses_kernel.hpp"

namespace kinfer::batch {

using Wide = Pack<double, 4>;
using Narrow = Pack<float, 8>;
extern const Kernels avx2_kernels{"AVX2 + FMA",
                                  4,
                                  8,
                                  population_sums<Wide, 3>,
                                  population_sums<Narrow, 3>,
                                  sines<Wide>,
                                  point_errors<Wide, 3>,
                                  jacobian<Wide>,
                                  poses<Wide>};

}  // namespace kinfer::batch
