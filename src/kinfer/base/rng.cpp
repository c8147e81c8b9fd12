// SPDX-License-Identifier: Apache-2.0
#include "kinfer/base/rng.hpp"

#include <cmath>
#include <numbers>

#include "kinfer/base/expect.hpp"
#include "kinfer/base/instruction_set.hpp"
#include "kinfer/base/uniform_kernel.hpp"

namespace kinfer {
namespace {

using base::golden, base::mix;

base::UniformKernel best_uniform_kernel() {
#if defined(__x86_64__)
  if (instruction_set() == InstructionSet::avx512) return base::uniform_avx512;
  if (instruction_set() == InstructionSet::avx2) return base::uniform_avx2;
#endif
  return base::fill_uniform;
}

}  // namespace

Rng::Rng(std::uint64_t seed) : key_(mix(seed + golden)) {}

Rng Rng::stream(std::uint64_t name) const {
  Rng child;
  child.key_ = mix(key_ ^ mix(name * golden + 0x632be59bd9b4e019ULL));
  return child;
}

std::uint64_t Rng::bits() {
  return mix(key_ + ++counter_ * golden);
}

double Rng::uniform() {
  return static_cast<double>(bits() >> 11) * 0x1.0p-53;
}

void Rng::uniform(std::span<double> to) {
  static const base::UniformKernel fill = best_uniform_kernel();
  fill(key_ + counter_ * golden, to.size(), to.data());
  counter_ += to.size();
}

double Rng::uniform(double low, double high) {
  return low + (high - low) * uniform();
}

double Rng::normal() {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));  // 1 - u is never 0
  return radius * std::cos(2.0 * std::numbers::pi * uniform());
}

std::uint64_t Rng::index(std::uint64_t count) {
  KINFER_EXPECT(count > 0);
  // Rejection keeps every value equally likely: the incomplete last block of the 64-bit range is drawn again.
  const std::uint64_t limit = -count % count;
  std::uint64_t draw = bits();
  while (draw < limit) draw = bits();
  return draw % count;
}

}  // namespace kinfer
