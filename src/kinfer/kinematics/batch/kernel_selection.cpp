// SPDX-License-Identifier: Apache-2.0
#include "kinfer/base/instruction_set.hpp"
#include "kinfer/kinematics/batch/kernel_interface.hpp"

namespace kinfer::batch {

KernelList runnable_kernels() {
  KernelList list;
  list.kernels[list.count++] = &portable_kernels;
#if defined(__x86_64__)
  if (instruction_set() >= InstructionSet::avx2) list.kernels[list.count++] = &avx2_kernels;
  if (instruction_set() >= InstructionSet::avx512) list.kernels[list.count++] = &avx512_kernels;
#endif
  return list;
}

const Kernels& best_kernels() {
  static const KernelList list = runnable_kernels();
  return *list.kernels[list.count - 1];
}

}  // namespace kinfer::batch
