#include "kinfer/kinematics/batch_kernel.hpp"

namespace kinfer::batch {

KernelList runnable_kernels() {
  KernelList list;
  list.kernels[list.count++] = &portable_kernels;
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) list.kernels[list.count++] = &avx2_kernels;
  if (__builtin_cpu_supports("avx512f")) list.kernels[list.count++] = &avx512_kernels;
#endif
  return list;
}

const Kernels& best_kernels() {
  static const KernelList list = runnable_kernels();
  return *list.kernels[list.count - 1];
}

}  // namespace kinfer::batch
