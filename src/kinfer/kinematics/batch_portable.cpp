// The batch kernels for any processor: two numbers at a time, as every 64-bit one has them.
#include "kinfer/kinematics/batch_jacobian_kernel.hpp"
#include "kinfer/kinematics/batch_sums_kernel.hpp"

namespace kinfer::batch {

using Wide = Pack<double, 2>;
using Narrow = Pack<float, 4>;
const Kernels portable_kernels{
    "portable",    2, 4, population_sums<Wide, 2>, population_sums<Narrow, 2>, sines<Wide>, point_errors<Wide, 2>,
    jacobian<Wide>};

}  // namespace kinfer::batch
