// SPDX-License-Identifier: Apache-2.0
// Many SplitMix64 draws at once, for files that are each compiled for one instruction set. A plain loop over integers:
// every processor gives the same bits.
#pragma once

#include <cstddef>
#include <cstdint>

namespace kinfer::base {

/// Writes mix(first + k · golden), k = 1 .. count, as numbers in [0, 1).
using UniformKernel = void (*)(std::uint64_t first, std::size_t count, double* to);

namespace {  // one copy per kernel file, compiled for its instruction set

constexpr std::uint64_t golden = 0x9e3779b97f4a7c15ULL;

[[gnu::always_inline]] inline constexpr std::uint64_t mix(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

/// The upper 53 bits divided by 2⁵³, exact. Where the processor cannot convert several 64-bit integers to doubles at
/// once, the two halves are converted through their exponent bits: 2⁸⁴ + high · 2³² and 2⁵² + low.
[[gnu::always_inline]] inline double in_unit_interval(std::uint64_t bits) {
  const std::uint64_t whole = bits >> 11;
#if defined(__AVX512DQ__)
  return static_cast<double>(static_cast<std::int64_t>(whole)) * 0x1p-53;
#else
  const auto high = __builtin_bit_cast(double, (whole >> 32) | 0x4530000000000000ULL);
  const auto low = __builtin_bit_cast(double, (whole & 0xffffffffULL) | 0x4330000000000000ULL);
  return ((high - (0x1p84 + 0x1p52)) + low) * 0x1p-53;
#endif
}

[[maybe_unused]] void fill_uniform(std::uint64_t first, std::size_t count, double* to) {
  for (std::size_t k = 0; k < count; ++k) to[k] = in_unit_interval(mix(first + (k + 1) * golden));
}

}  // namespace

#if defined(__x86_64__)
extern const UniformKernel uniform_avx2, uniform_avx512;
#endif

}  // namespace kinfer::base
