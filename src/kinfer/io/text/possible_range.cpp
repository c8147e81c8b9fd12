// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/text/possible_range.hpp"

#include <fmt/format.h>

#include <cmath>

namespace kinfer {

PossibleRange possible_range(Dimension dimension) {
  switch (dimension) {
    case Dimension::length:
      return possible::length;
    case Dimension::angle:
      return possible::angle;
    case Dimension::mass:
      return possible::payload;
    case Dimension::temperature:
      return possible::temperature;
    case Dimension::time:
      return {"a time", 1e12, "s"};  // nanoseconds since 1970 that are read as seconds are not
    case Dimension::torque:
      return {"a torque", 1e9, "N.m"};
    case Dimension::acceleration:
      return {"an acceleration", 1e6, "m/s^2"};
    case Dimension::angular_rate:
      return {"an angular rate", 1e6, "rad/s"};
    case Dimension::magnetic_field:
      return {"a magnetic field", 1e9, "uT"};
    case Dimension::area:
    case Dimension::square_angle:
    case Dimension::length_times_angle:
      return {"a covariance", 1e10, "SI"};
    case Dimension::one:
      return possible::number;
  }
  return possible::number;
}

std::optional<std::string> impossible(double value, const PossibleRange& range) {
  constexpr double rounding = 1e-9;  // a value at the limit that was written in another unit comes back beyond it
  const bool is_too_small = value < range.least - rounding * std::abs(range.least);
  if (!is_too_small && value <= range.most * (1.0 + rounding)) return std::nullopt;
  const std::string unit = range.unit == "1" || range.unit == "SI" ? "" : fmt::format(" {}", range.unit);
  if (is_too_small && range.least != -range.most)
    return fmt::format("{:g}{} is not possible for {} (at least {:g}{})", value, unit, range.what, range.least, unit);
  return fmt::format("{:g}{} is not possible for {} (at most {:g}{})", value, unit, range.what, range.most, unit);
}

}  // namespace kinfer
