// SPDX-License-Identifier: Apache-2.0
// What a physical quantity of a machine can be at all. A number outside is a slip of the unit or of the decimal point;
// it is refused where it is read, before it becomes an infinite residual or a matrix that nobody can store.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "kinfer/base/largest_length.hpp"
#include "kinfer/io/text/units.hpp"

namespace kinfer {

/// Limits far beyond any machine: they separate slips from measurements, not good from bad.
struct PossibleRange {
  std::string_view what;  ///< "a length"
  double most = 0.0;      ///< in `unit`
  std::string_view unit;  ///< SI
  double least = -most;
};

namespace possible {

inline constexpr PossibleRange length{"a length", largest_length, "m"};
inline constexpr PossibleRange angle{"an angle", 1e4, "rad"};
inline constexpr PossibleRange ratio{"a gain", 1e4, "1"};
inline constexpr PossibleRange compliance{"a compliance", 10.0, "rad/(N m)"};
inline constexpr PossibleRange harmonic_order{"an order of a harmonic", 1e5, "1"};
inline constexpr PossibleRange mass{"a mass", 1e8, "kg"};
inline constexpr PossibleRange payload{"a payload", 1e8, "kg",
                                       0.0};  // that the robot carries; masses of a model may be differences
inline constexpr PossibleRange gravity{"a gravity", 1e3, "m/s^2"};
inline constexpr PossibleRange expansion{"a thermal expansion", 1.0, "1/K"};
inline constexpr PossibleRange temperature{"a temperature", 1e4, "C", -273.15};
inline constexpr PossibleRange motion_limit{"a limit of a motion", 1e12, "SI"};  // jerks of 1e9 deg/s^3 mean none
/// Of a number in any file whose quantity has no range of its own: its square and the sums of squares stay finite.
inline constexpr PossibleRange number{"a number of a machine", 1e15, "SI"};

}  // namespace possible

/// Of values with this dimension, in the units of `find_unit`.
PossibleRange possible_range(Dimension dimension);

/// "1e+300 m is not possible for a length (at most 2e+07 m)" where the value is outside or not finite; nothing
/// otherwise.
std::optional<std::string> impossible(double value, const PossibleRange& range);

}  // namespace kinfer
