// SPDX-License-Identifier: Apache-2.0
#include "kinfer/report/parts/packed.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

namespace kinfer::report {
namespace {

constexpr std::uint16_t missing = 65535;
constexpr double most_steps = 65534.0;

}  // namespace

std::string base64(std::span<const unsigned char> bytes) {
  constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t left = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) word = word << 8 | (k < left ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k) text += k <= left ? digits[word >> (18 - 6 * k) & 63U] : '=';
  }
  return text;
}

nlohmann::ordered_json packed(std::span<const double> values) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double value : values)
    if (std::isfinite(value)) low = std::min(low, value), high = std::max(high, value);
  const double step = high > low && std::isfinite(high - low) ? (high - low) / most_steps : 1.0;
  const double zero = low <= high ? low : 0.0;
  std::vector<unsigned char> bytes;
  for (const double value : values) {
    const auto steps = std::isfinite(value) ? static_cast<std::uint16_t>(std::lround((value - zero) / step)) : missing;
    bytes.push_back(static_cast<unsigned char>(steps & 255U));
    bytes.push_back(static_cast<unsigned char>(steps >> 8));
  }
  return {{"zero", zero}, {"step", step}, {"packed", base64(bytes)}};
}

}  // namespace kinfer::report
