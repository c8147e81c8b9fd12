// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/text/plain_decimal.hpp"

#include <array>

namespace kinfer {
namespace {

constexpr std::array<double, 23> powers_of_ten{1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                               1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
constexpr std::uint64_t largest_exact = std::uint64_t{1} << 53;
constexpr int max_digits = 19;  // fit 64 bits

bool is_digit(char c) {
  return static_cast<unsigned char>(c - '0') < 10;
}

struct Digits {
  std::uint64_t value = 0;
  int count = 0;
};

const char* read_digits(const char* at, const char* end, Digits& digits) {
  for (; at != end && is_digit(*at); ++at, ++digits.count) digits.value = 10 * digits.value + std::uint64_t(*at - '0');
  return at;
}

/// "e-5" at `at`; null where an e is not followed by a number of at most three digits.
const char* read_exponent(const char* at, const char* end, int& exponent) {
  ++at;
  const bool negative = at != end && *at == '-';
  if (at != end && (*at == '-' || *at == '+')) ++at;
  Digits digits;
  at = read_digits(at, end, digits);
  if (digits.count == 0 || digits.count > 3) return nullptr;
  exponent += negative ? -static_cast<int>(digits.value) : static_cast<int>(digits.value);
  return at;
}

}  // namespace

const char* read_plain_decimal(const char* at, const char* end, double& value) {
  const bool negative = at != end && *at == '-';
  if (negative) ++at;
  Digits digits;
  at = read_digits(at, end, digits);
  int exponent = 0;
  if (at != end && *at == '.') {
    const int before = digits.count;
    at = read_digits(at + 1, end, digits);
    exponent = before - digits.count;
  }
  if (digits.count == 0 || digits.count > max_digits || digits.value > largest_exact) return nullptr;
  if (at != end && (*at == 'e' || *at == 'E')) {
    at = read_exponent(at, end, exponent);
    if (!at) return nullptr;
  }
  if (exponent < -22 || exponent > 22) return nullptr;
  const double magnitude = static_cast<double>(digits.value);
  const double scaled = exponent < 0 ? magnitude / powers_of_ten[static_cast<std::size_t>(-exponent)]
                                     : magnitude * powers_of_ten[static_cast<std::size_t>(exponent)];
  value = negative ? -scaled : scaled;
  return at;
}

}  // namespace kinfer
