#include "kinfer/base/rng.hpp"

#include <cmath>
#include <numbers>

#include "kinfer/base/expect.hpp"

namespace kinfer {
namespace {

constexpr std::uint64_t golden = 0x9e3779b97f4a7c15ULL;

constexpr std::uint64_t mix(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
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
  const std::uint64_t first = key_ + counter_ * golden;
  for (std::size_t i = 0; i < to.size(); ++i)
    to[i] = static_cast<double>(mix(first + (i + 1) * golden) >> 11) * 0x1.0p-53;
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
