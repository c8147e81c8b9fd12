// SPDX-License-Identifier: Apache-2.0
// Peak of one core: independent fused multiply-adds and nothing else.
#pragma once

namespace kinfer::bench {

/// Runs 10 · `rounds` pack-wide multiply-adds with packs of four and of eight doubles.
void multiply_adds_avx2(int rounds);
void multiply_adds_avx512(int rounds);

}  // namespace kinfer::bench
