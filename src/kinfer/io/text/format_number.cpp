// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/text/format_number.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>

namespace kinfer {
namespace {

double read_back(const std::string& text) {
  double value = 0.0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

}  // namespace

std::string format_number(double value, double factor) {
  const double scaled = value / factor;
  std::string plain = fmt::format("{:.12g}", scaled);
  if (std::abs(factor * read_back(plain) - value) <= std::numeric_limits<double>::epsilon() * std::abs(value))
    return plain;
  for (const int precision : {15, 16, 17}) {
    std::string text = fmt::format("{:.{}g}", scaled, precision);
    if (factor * read_back(text) == value) return text;
  }
  return fmt::format("{}", scaled);
}

}  // namespace kinfer
