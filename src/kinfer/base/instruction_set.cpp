// SPDX-License-Identifier: Apache-2.0
#include "kinfer/base/instruction_set.hpp"

namespace kinfer {
namespace {

InstructionSet detect_instruction_set() {
#if defined(__x86_64__)
  const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  const bool avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq");
  if (avx2) return avx512 ? InstructionSet::avx512 : InstructionSet::avx2;
#endif
  return InstructionSet::portable;
}

}  // namespace

InstructionSet instruction_set() {
  static const InstructionSet set = detect_instruction_set();
  return set;
}

}  // namespace kinfer
