// SPDX-License-Identifier: Apache-2.0
// Run-time detection of the instruction set, shared by all kernels that are compiled for several.
#pragma once

namespace kinfer {

/// Each includes the ones before it. avx2: with fused multiply-add; avx512: F and DQ.
enum class InstructionSet { portable, avx2, avx512 };

/// The widest instruction set that this processor supports.
InstructionSet instruction_set();

}  // namespace kinfer
