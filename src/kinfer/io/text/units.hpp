// SPDX-License-Identifier: Apache-2.0
// Units in column headers and TOML files, converted once, on reading.
#pragma once

#include <optional>
#include <string_view>

namespace kinfer {

enum class Dimension {
  length,
  area,
  angle,
  square_angle,
  length_times_angle,
  time,
  mass,
  torque,
  acceleration,
  angular_rate,
  magnetic_field,
  temperature,
  one
};

struct Unit {
  Dimension dimension = Dimension::one;
  double factor = 1.0;  ///< SI value = factor · (value + offset); magnetic fields are in µT
  double offset = 0.0;
};

/// m mm um, rad deg mrad, their squares (mm^2) and products (mm.deg), s ms us ns, kg, N.m, m/s^2 g mg, rad/s deg/s, uT
/// mT nT T G, C K, 1, and other spellings of them (m/s², °/s, dps, Gauss); empty for any other text. "g" is the
/// acceleration. Temperatures are converted to °C.
std::optional<Unit> find_unit(std::string_view text);

/// Name of a dimension for error messages: "a length (m, mm, um)".
std::string_view describe(Dimension dimension);

/// `header` "q1[deg]" -> name "q1", unit "deg"; no bracket: empty unit. "x (mm)" likewise, if the unit is known.
/// Without the apostrophe of csv_cell.
struct ColumnHeader {
  std::string_view name, unit;
  bool has_unit = false;
};
ColumnHeader parse_column_header(std::string_view header);

/// Units in which files are written.
enum class FileUnits { si, mm_deg };

}  // namespace kinfer
