// SPDX-License-Identifier: Apache-2.0
// Run-time detection of the instruction set, shared by all kernels that are compiled for several.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace kinfer {

/// Each includes the ones before it. avx2: with fused multiply-add; avx512: F and DQ.
enum class InstructionSet { portable, avx2, avx512 };
std::string_view name(InstructionSet set);  ///< "portable", "avx2", "avx512"
std::optional<InstructionSet> instruction_set_named(std::string_view name);

/// The widest instruction set that this processor supports.
InstructionSet widest_instruction_set();

/// The instruction set of all kernels: the widest, or the one that was pinned.
InstructionSet instruction_set();

/// All kernels use `set` from now on; once, before the first of them runs, because each keeps its choice. False where
/// the processor does not support it.
bool pin_instruction_set(InstructionSet set);

/// Results are equal to the bit on processors of one class with one choice of kernels: "x86_64 avx512, kernels avx2".
/// The first part is that of the processor, by which the C library chooses its own sines and cosines.
std::string processor_class();

}  // namespace kinfer
