// SPDX-License-Identifier: Apache-2.0
#include "kinfer/base/instruction_set.hpp"

#include <array>
#include <atomic>

namespace kinfer {
namespace {

constexpr std::array<std::string_view, 3> instruction_set_names{"portable", "avx2", "avx512"};

InstructionSet detect_instruction_set() {
#if defined(__x86_64__)
  const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  const bool avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq");
  if (avx2) return avx512 ? InstructionSet::avx512 : InstructionSet::avx2;
#endif
  return InstructionSet::portable;
}

std::atomic<InstructionSet>& chosen_instruction_set() {
  static std::atomic<InstructionSet> set = widest_instruction_set();
  return set;
}

}  // namespace

std::string_view name(InstructionSet set) {
  return instruction_set_names[static_cast<std::size_t>(set)];
}

std::optional<InstructionSet> instruction_set_named(std::string_view name) {
  for (std::size_t i = 0; i < instruction_set_names.size(); ++i)
    if (instruction_set_names[i] == name) return static_cast<InstructionSet>(i);
  return std::nullopt;
}

InstructionSet widest_instruction_set() {
  static const InstructionSet set = detect_instruction_set();
  return set;
}

InstructionSet instruction_set() {
  return chosen_instruction_set();
}

bool pin_instruction_set(InstructionSet set) {
  if (set > widest_instruction_set()) return false;
  chosen_instruction_set() = set;
  return true;
}

std::string processor_class() {
#if defined(__x86_64__)
  const std::string architecture = "x86_64";
#elif defined(__aarch64__)
  const std::string architecture = "aarch64";
#else
  const std::string architecture = "other";
#endif
  return architecture + " " + std::string(name(widest_instruction_set())) + ", kernels " +
         std::string(name(instruction_set()));
}

}  // namespace kinfer
