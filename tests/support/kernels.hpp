// SPDX-License-Identifier: Apache-2.0
// The batch kernels that this processor can run.
#pragma once

#include <vector>

#include "kinfer/kinematics/batch/kernel_interface.hpp"

namespace kinfer::test {

inline std::vector<const batch::Kernels*> kernels_to_run() {
  const batch::KernelList list = batch::runnable_kernels();
  return {list.kernels, list.kernels + list.count};
}

}  // namespace kinfer::test
