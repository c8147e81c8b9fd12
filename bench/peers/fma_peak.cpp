// SPDX-License-Identifier: Apache-2.0
#include "peers/fma_peak.hpp"

#include <immintrin.h>

namespace kinfer::bench {
namespace {

/// Ten chains cover a latency of five cycles on two pipes; assembly, so that no compiler removes them.
template <class V>
[[gnu::always_inline]] inline void ten_chains(int rounds) {
  constexpr int chains = 10;
  const V one = V{} + 1.0;
  V sum[chains];
#pragma GCC unroll 10
  for (int i = 0; i < chains; ++i) sum[i] = one;
  for (int round = 0; round < rounds; ++round) {
#pragma GCC unroll 10
    for (int i = 0; i < chains; ++i) asm volatile("vfmadd231pd %1, %1, %0" : "+v"(sum[i]) : "v"(one));
  }
}

}  // namespace

[[gnu::target("avx2,fma")]] void multiply_adds_avx2(int rounds) {
  ten_chains<__m256d>(rounds);
}
[[gnu::target("avx512f")]] void multiply_adds_avx512(int rounds) {
  ten_chains<__m512d>(rounds);
}

}  // namespace kinfer::bench
