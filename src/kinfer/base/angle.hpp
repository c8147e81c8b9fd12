// SPDX-License-Identifier: Apache-2.0
// An angle with explicit units: constructed and read in radians or degrees, so that the two cannot be confused.
#pragma once

#include <cmath>
#include <compare>
#include <numbers>

namespace kinfer {

inline constexpr double degree = std::numbers::pi / 180.0;  // [rad]

/// Less full turns: in [−π, π] [rad].
inline double wrap_to_pi(double angle) {
  return std::remainder(angle, 2.0 * std::numbers::pi);
}

class Angle {
 public:
  constexpr Angle() = default;
  static constexpr Angle rad(double value) { return Angle(value); }
  static constexpr Angle deg(double value) { return Angle(value * degree); }
  constexpr double rad() const { return rad_; }
  constexpr double deg() const { return rad_ / degree; }

  constexpr Angle operator+(Angle other) const { return Angle(rad_ + other.rad_); }
  constexpr Angle operator-(Angle other) const { return Angle(rad_ - other.rad_); }
  constexpr Angle operator-() const { return Angle(-rad_); }
  constexpr Angle operator*(double factor) const { return Angle(rad_ * factor); }
  constexpr auto operator<=>(const Angle&) const = default;

 private:
  constexpr explicit Angle(double value) : rad_(value) {}
  double rad_ = 0.0;
};

inline namespace literals {
constexpr Angle operator""_deg(long double value) {
  return Angle::deg(static_cast<double>(value));
}
constexpr Angle operator""_deg(unsigned long long value) {
  return Angle::deg(static_cast<double>(value));
}
constexpr Angle operator""_rad(long double value) {
  return Angle::rad(static_cast<double>(value));
}
}  // namespace literals

}  // namespace kinfer
