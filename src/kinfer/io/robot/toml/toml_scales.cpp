// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot/toml/toml_scales.hpp"

#include <fmt/format.h>

#include "kinfer/io/text/units.hpp"

namespace kinfer {
namespace {

double scale_of(TableReader& units, std::string_view key, Dimension dimension) {
  const std::string name = units.text_or(key, dimension == Dimension::length ? "m" : "rad");
  const auto unit = find_unit(name);
  if (unit && unit->dimension == dimension) return unit->factor;
  units.report_error(units.line_of(key),
                     fmt::format("\"{}\": expected {}, found \"{}\"", key, describe(dimension), name));
  return 1.0;
}

}  // namespace

Scales read_scales(TableReader& file, FirstError& first_error) {
  const TomlTable* table = file.table_or_none("units");
  if (!table) return {};
  TableReader units(*table, file.line_of("units"), "units: ", first_error);
  const Scales scales{scale_of(units, "length", Dimension::length), scale_of(units, "angle", Dimension::angle)};
  units.expect_no_other_keys();
  return scales;
}

Frame read_frame(TableReader& file, std::string_view key, const Scales& scales, FirstError& first_error) {
  file.ignore(std::string(key) + "_sd");
  const TomlTable* table = file.table_or_none(key);
  if (!table) return {};
  TableReader frame(*table, file.line_of(key), std::string(key) + ": ", first_error);
  const Vec3 xyz = frame.vector_or("xyz", Vec3::Zero()), rpy = frame.vector_or("rpy", Vec3::Zero());
  frame.expect_no_other_keys();
  return {xyz * scales.length, from_rpy(rpy * scales.angle), Vec3::Zero()};
}

}  // namespace kinfer
