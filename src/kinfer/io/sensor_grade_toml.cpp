#include "kinfer/io/sensor_grade_toml.hpp"

#include <cmath>

#include "kinfer/io/digits.hpp"
#include "kinfer/io/text_file.hpp"
#include "kinfer/io/toml_tree.hpp"
#include "kinfer/io/units.hpp"

namespace kinfer {
namespace {

double unit_factor(TableReader& units, std::string_view key, std::string_view absent, Dimension dimension) {
  const std::string name = units.text_or(key, std::string(absent));
  const auto unit = find_unit(name);
  if (unit && unit->dimension == dimension) return unit->factor;
  units.complain(units.line_of(key), fmt::format("\"{}\": expected {}, found \"{}\"", key, describe(dimension), name));
  return 1.0;
}

struct Factors {
  double acceleration = 1.0, angular_rate = 1.0, magnetic_field = 1.0;
};

Factors read_factors(TableReader& file, Complaint& complaint) {
  const TomlTable* table = file.table_or_none("units");
  if (!table) return {};
  TableReader units(*table, file.line_of("units"), "units: ", complaint);
  const Factors factors{unit_factor(units, "acceleration", "m/s^2", Dimension::acceleration),
                        unit_factor(units, "angular_rate", "rad/s", Dimension::angular_rate),
                        unit_factor(units, "magnetic_field", "uT", Dimension::magnetic_field)};
  units.expect_no_other_keys();
  return factors;
}

double not_negative(TableReader& table, std::string_view key, double absent) {
  const double value = table.number_or(key, absent);
  if (value < 0.0)
    table.complain(table.line_of(key), fmt::format("\"{}\": expected a number that is not negative", key));
  return value;
}

InstrumentModel read_instrument(TableReader& file, std::string_view key, double factor, Complaint& complaint) {
  const TomlTable* found = file.table_or_none(key);
  if (!found) return {};
  TableReader table(*found, file.line_of(key), std::string(key) + ": ", complaint);
  InstrumentModel model;
  model.noise_density = factor * not_negative(table, "noise_density", 0.0);
  model.bias_sd = factor * not_negative(table, "bias", 0.0);
  model.instability = factor * not_negative(table, "instability", 0.0);
  model.instability_time = table.positive_or("instability_time", model.instability_time);
  model.scale_sd = not_negative(table, "scale", 0.0);
  if (table.has("range")) model.range = factor * table.positive_or("range", 1.0);
  model.resolution = factor * not_negative(table, "resolution", 0.0);
  table.expect_no_other_keys();
  return model;
}

std::string instrument_toml(std::string_view key, const InstrumentModel& model) {
  std::string text =
      fmt::format("\n[{}]\nnoise_density = {}\nbias = {}\ninstability = {}\ninstability_time = {}\nscale = {}\n", key,
                  digits(model.noise_density), digits(model.bias_sd), digits(model.instability),
                  digits(model.instability_time), digits(model.scale_sd));
  if (std::isfinite(model.range)) text += fmt::format("range = {}\n", digits(model.range));
  return text + fmt::format("resolution = {}\n", digits(model.resolution));
}

}  // namespace

Result<SensorModel> parse_sensor_grade(std::string_view text, const std::string& name) {
  KINFER_TRY(tree, parse_toml(text, name));
  Complaint complaint(name);
  TableReader file(tree, 1, "", complaint);
  SensorModel model;
  model.name = file.text_or("name", std::filesystem::path(name).stem().string());
  const Factors factors = read_factors(file, complaint);
  model.accelerometer = read_instrument(file, "accelerometer", factors.acceleration, complaint);
  model.gyroscope = read_instrument(file, "gyroscope", factors.angular_rate, complaint);
  model.magnetometer = read_instrument(file, "magnetometer", factors.magnetic_field, complaint);
  file.expect_no_other_keys();
  if (complaint.any()) return pass_on(complaint.as_error());
  return model;
}

Result<SensorModel> read_sensor_grade(const std::filesystem::path& path) {
  KINFER_TRY(text, read_text_file(path));
  return parse_sensor_grade(text, path.string());
}

std::string sensor_grade_toml(const SensorModel& model) {
  return fmt::format("name = \"{}\"\n", model.name) + instrument_toml("accelerometer", model.accelerometer) +
         instrument_toml("gyroscope", model.gyroscope) + instrument_toml("magnetometer", model.magnetometer);
}

}  // namespace kinfer
