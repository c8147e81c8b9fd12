// What this processor can do: one answer for every kernel that is compiled for several instruction sets.
#pragma once

namespace kinfer {

/// Each holds the ones before it. avx2: with fused multiply-adds; avx512: F and DQ.
enum class InstructionSet { portable, avx2, avx512 };

/// The richest that this processor runs.
InstructionSet instruction_set();

}  // namespace kinfer
