// SPDX-License-Identifier: Apache-2.0
// The batch kernels for any processor: two doubles at a time, which every 64-bit processor supports.
#include "kinfer/kinematics/batch/errors_kernel.hpp"
#include "kinfer/kinematics/batch/jacobian_kernel.hpp"
#include "kinfer/kinematics/batch/poses_kernel.hpp"

namespace kinfer::batch {

using Wide = Pack<double, 2>;
using Narrow = Pack<float, 4>;
const Kernels portable_kernels{"portable",
                               2,
                               4,
                               population_sums<Wide, 2>,
                               population_sums<Narrow, 2>,
                               sines<Wide>,
                               point_errors<Wide, 2>,
                               jacobian<Wide>,
                               poses<Wide>};

}  // namespace kinfer::batch
