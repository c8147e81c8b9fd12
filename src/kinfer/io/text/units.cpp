// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/text/units.hpp"

#include <array>

#include "kinfer/base/angle.hpp"
#include "kinfer/base/constants.hpp"
#include "kinfer/io/text/csv_text.hpp"
#include "kinfer/io/text/trim.hpp"

namespace kinfer {
namespace {

struct NamedUnit {
  std::string_view name;
  Unit unit;
};

constexpr std::string_view whitespace_and_newline = " \t\r\n";

constexpr std::array named_units{
    NamedUnit{"m", {Dimension::length, 1.0}},
    NamedUnit{"mm", {Dimension::length, 1e-3}},
    NamedUnit{"um", {Dimension::length, 1e-6}},
    NamedUnit{"µm", {Dimension::length, 1e-6}},
    NamedUnit{"m^2", {Dimension::area, 1.0}},
    NamedUnit{"mm^2", {Dimension::area, 1e-6}},
    NamedUnit{"um^2", {Dimension::area, 1e-12}},
    NamedUnit{"µm^2", {Dimension::area, 1e-12}},
    NamedUnit{"rad^2", {Dimension::square_angle, 1.0}},
    NamedUnit{"deg^2", {Dimension::square_angle, degree* degree}},
    NamedUnit{"mrad^2", {Dimension::square_angle, 1e-6}},
    NamedUnit{"m.rad", {Dimension::length_times_angle, 1.0}},
    NamedUnit{"m.deg", {Dimension::length_times_angle, degree}},
    NamedUnit{"m.mrad", {Dimension::length_times_angle, 1e-3}},
    NamedUnit{"mm.rad", {Dimension::length_times_angle, 1e-3}},
    NamedUnit{"mm.deg", {Dimension::length_times_angle, 1e-3 * degree}},
    NamedUnit{"mm.mrad", {Dimension::length_times_angle, 1e-6}},
    NamedUnit{"rad", {Dimension::angle, 1.0}},
    NamedUnit{"deg", {Dimension::angle, degree}},
    NamedUnit{"mrad", {Dimension::angle, 1e-3}},
    NamedUnit{"s", {Dimension::time, 1.0}},
    NamedUnit{"ms", {Dimension::time, 1e-3}},
    NamedUnit{"us", {Dimension::time, 1e-6}},
    NamedUnit{"µs", {Dimension::time, 1e-6}},
    NamedUnit{"ns", {Dimension::time, 1e-9}},
    NamedUnit{"kg", {Dimension::mass, 1.0}},
    NamedUnit{"N.m", {Dimension::torque, 1.0}},
    NamedUnit{"m/s^2", {Dimension::acceleration, 1.0}},
    NamedUnit{"m/s²", {Dimension::acceleration, 1.0}},
    NamedUnit{"m/s2", {Dimension::acceleration, 1.0}},
    NamedUnit{"g", {Dimension::acceleration, standard_gravity}},
    NamedUnit{"mg", {Dimension::acceleration, 1e-3 * standard_gravity}},
    NamedUnit{"rad/s", {Dimension::angular_rate, 1.0}},
    NamedUnit{"deg/s", {Dimension::angular_rate, degree}},
    NamedUnit{"°/s", {Dimension::angular_rate, degree}},
    NamedUnit{"dps", {Dimension::angular_rate, degree}},
    NamedUnit{"uT", {Dimension::magnetic_field, 1.0}},
    NamedUnit{"µT", {Dimension::magnetic_field, 1.0}},
    NamedUnit{"\u03bcT", {Dimension::magnetic_field, 1.0}},
    NamedUnit{"mT", {Dimension::magnetic_field, 1e3}},
    NamedUnit{"nT", {Dimension::magnetic_field, 1e-3}},
    NamedUnit{"T", {Dimension::magnetic_field, 1e6}},
    NamedUnit{"G", {Dimension::magnetic_field, 100.0}},
    NamedUnit{"Gauss", {Dimension::magnetic_field, 100.0}},
    NamedUnit{"C", {Dimension::temperature, 1.0}},
    NamedUnit{"K", {Dimension::temperature, 1.0, -273.15}},
    NamedUnit{"1", {Dimension::one, 1.0}},
};

}  // namespace

std::optional<Unit> find_unit(std::string_view text) {
  for (const NamedUnit& named : named_units)
    if (named.name == text) return named.unit;
  return std::nullopt;
}

std::string_view describe(Dimension dimension) {
  switch (dimension) {
    case Dimension::length:
      return "a length (m, mm, um)";
    case Dimension::area:
      return "a variance of lengths (m^2, mm^2, um^2)";
    case Dimension::square_angle:
      return "a variance of angles (rad^2, deg^2, mrad^2)";
    case Dimension::length_times_angle:
      return "a covariance of a length with an angle (m.rad, mm.deg, mm.mrad)";
    case Dimension::angle:
      return "an angle (rad, deg, mrad)";
    case Dimension::time:
      return "a time (s, ms, us)";
    case Dimension::mass:
      return "a mass (kg)";
    case Dimension::torque:
      return "a torque (N.m)";
    case Dimension::acceleration:
      return "an acceleration (m/s^2, g)";
    case Dimension::angular_rate:
      return "an angular rate (rad/s, deg/s)";
    case Dimension::magnetic_field:
      return "a magnetic field (uT, mT, T, G)";
    case Dimension::temperature:
      return "a temperature (C, K)";
    case Dimension::one:
      return "a plain number (1)";
  }
  return "a known unit";
}

ColumnHeader parse_column_header(std::string_view header) {
  const std::string_view text = without_formula_guard(trim(header, whitespace_and_newline));
  if (const auto paren = text.rfind('('); paren != std::string_view::npos && text.back() == ')') {
    const std::string_view unit = trim(text.substr(paren + 1, text.size() - paren - 2), whitespace_and_newline);
    if (find_unit(unit)) return {trim(text.substr(0, paren), whitespace_and_newline), unit, true};
  }
  const auto open = text.rfind('[');
  if (open == std::string_view::npos || text.back() != ']') return {text, {}, false};
  return {trim(text.substr(0, open), whitespace_and_newline),
          trim(text.substr(open + 1, text.size() - open - 2), whitespace_and_newline), true};
}

}  // namespace kinfer
