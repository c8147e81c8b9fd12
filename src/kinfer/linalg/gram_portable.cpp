// Normal equations for any processor: two numbers at a time, as every 64-bit one has them.
#include "kinfer/linalg/gram_kernel.hpp"

namespace kinfer::batch {

const GramKernel portable_gram{2, normal_equations<Pack<double, 2>>};

}  // namespace kinfer::batch
