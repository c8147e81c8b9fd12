// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/recording/sensor_grade_toml.hpp"

#include <cmath>

#include "kinfer/io/files/text_file.hpp"
#include "kinfer/io/text/format_number.hpp"
#include "kinfer/io/text/quoted_text.hpp"
#include "kinfer/io/text/toml_reader.hpp"
#include "kinfer/io/text/units.hpp"

namespace kinfer {
namespace {

double unit_factor(TableReader& units, std::string_view key, std::string_view fallback, Dimension dimension) {
  const std::string name = units.text_or(key, std::string(fallback));
  const auto unit = find_unit(name);
  if (unit && unit->dimension == dimension) return unit->factor;
  units.report_error(units.line_of(key),
                     fmt::format("\"{}\": expected {}, found \"{}\"", key, describe(dimension), name));
  return 1.0;
}

struct Factors {
  double acceleration = 1.0, angular_rate = 1.0, magnetic_field = 1.0;
};

Factors read_factors(TableReader& file, FirstError& first_error) {
  const TomlTable* table = file.table_or_none("units");
  if (!table) return {};
  TableReader units(*table, file.line_of("units"), "units: ", first_error);
  const Factors factors{unit_factor(units, "acceleration", "m/s^2", Dimension::acceleration),
                        unit_factor(units, "angular_rate", "rad/s", Dimension::angular_rate),
                        unit_factor(units, "magnetic_field", "uT", Dimension::magnetic_field)};
  units.expect_no_other_keys();
  return factors;
}

/// In SI; `fallback` is in SI too.
double magnitude_or(TableReader& table, std::string_view key, double fallback, double factor,
                    const PossibleRange& range) {
  const double value = table.has(key) ? factor * table.number(key) : fallback;
  if (value < 0.0)
    table.report_error(table.line_of(key), fmt::format("\"{}\": expected a number that is not negative", key));
  table.expect_possible(key, value, range);
  return value;
}

InstrumentModel read_instrument(TableReader& file, std::string_view key, double factor, Dimension dimension,
                                FirstError& first_error) {
  const TomlTable* found = file.table_or_none(key);
  if (!found) return {};
  TableReader table(*found, file.line_of(key), std::string(key) + ": ", first_error);
  InstrumentModel model;
  const PossibleRange range = possible_range(dimension);
  model.noise_density = magnitude_or(table, "noise_density", 0.0, factor, range);
  model.bias_sd = magnitude_or(table, "bias", 0.0, factor, range);
  model.instability = magnitude_or(table, "instability", 0.0, factor, range);
  model.instability_time = table.positive_or("instability_time", model.instability_time);
  table.expect_possible("instability_time", model.instability_time, possible_range(Dimension::time));
  model.scale_sd = magnitude_or(table, "scale", 0.0, 1.0, possible::ratio);
  if (table.has("range")) {
    model.range = factor * table.positive_or("range", 1.0);
    table.expect_possible("range", model.range, range);
  }
  model.resolution = magnitude_or(table, "resolution", 0.0, factor, range);
  table.expect_no_other_keys();
  return model;
}

std::string instrument_toml(std::string_view key, const InstrumentModel& model) {
  std::string text =
      fmt::format("\n[{}]\nnoise_density = {}\nbias = {}\ninstability = {}\ninstability_time = {}\nscale = {}\n", key,
                  format_number(model.noise_density), format_number(model.bias_sd), format_number(model.instability),
                  format_number(model.instability_time), format_number(model.scale_sd));
  if (std::isfinite(model.range)) text += fmt::format("range = {}\n", format_number(model.range));
  return text + fmt::format("resolution = {}\n", format_number(model.resolution));
}

}  // namespace

Result<SensorModel> parse_sensor_grade(std::string_view text, const std::string& name) {
  KINFER_TRY(tree, parse_toml(text, name));
  FirstError first_error(name);
  TableReader file(tree, 1, "", first_error);
  SensorModel model;
  model.name = file.text_or("name", std::filesystem::path(name).stem().string());
  const Factors factors = read_factors(file, first_error);
  model.accelerometer =
      read_instrument(file, "accelerometer", factors.acceleration, Dimension::acceleration, first_error);
  model.gyroscope = read_instrument(file, "gyroscope", factors.angular_rate, Dimension::angular_rate, first_error);
  model.magnetometer =
      read_instrument(file, "magnetometer", factors.magnetic_field, Dimension::magnetic_field, first_error);
  file.expect_no_other_keys();
  if (first_error.any()) return forward_error(first_error.as_error());
  return model;
}

Result<SensorModel> read_sensor_grade(const std::filesystem::path& path) {
  KINFER_TRY(text, read_text_file(path));
  return parse_sensor_grade(text, path.string());
}

std::string format_sensor_grade(const SensorModel& model) {
  return fmt::format("name = {}\n", quoted_text(model.name)) + instrument_toml("accelerometer", model.accelerometer) +
         instrument_toml("gyroscope", model.gyroscope) + instrument_toml("magnetometer", model.magnetometer);
}

}  // namespace kinfer
