// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot/toml/robot_errors_toml.hpp"

#include "kinfer/io/files/text_file.hpp"
#include "kinfer/io/text/toml_reader.hpp"

namespace kinfer {
namespace {

struct ErrorUnits {
  double length = 1.0, angle = 1.0;
};

ErrorUnits read_units(TableReader& root, FirstError& first_error) {
  ErrorUnits scales;
  const TomlTable* units = root.table_or_none("units");
  if (!units) return scales;
  TableReader reader(*units, root.line_of("units"), "units: ", first_error);
  const auto factor = [&](const char* key, Dimension dimension, const char* si) {
    const auto found = find_unit(reader.text_or(key, si));
    if (!found || found->dimension != dimension)
      reader.report_error(reader.line_of(key), fmt::format("{}: expected {}", key, describe(dimension)));
    return found ? found->factor : 1.0;
  };
  scales.length = factor("length", Dimension::length, "m");
  scales.angle = factor("angle", Dimension::angle, "rad");
  reader.expect_no_other_keys();
  return scales;
}

double si_factor(Quantity quantity, const ErrorUnits& scales) {
  if (quantity == Quantity::length) return scales.length;
  return quantity == Quantity::angle ? scales.angle : 1.0;
}

}  // namespace

Result<Chain> read_robot_errors(const std::filesystem::path& path, const RobotModel& robot) {
  KINFER_TRY(text, read_text_file(path));
  const std::string name = path.filename().string();
  KINFER_TRY(table, parse_toml(text, name));
  FirstError first_error(name);
  TableReader root(table, 1, "", first_error);
  const ErrorUnits scales = read_units(root, first_error);
  const TomlTable* errors = root.table_or_none("errors");
  root.expect_no_other_keys();
  if (!errors && !first_error.any())
    return error("{}: expected a table [errors] with name = value by parameter name", name);
  if (first_error.any()) return forward_error(first_error.as_error());

  const ParameterSet all = all_parameters(robot.chain, robot.tolerances);
  TableReader reader(*errors, root.line_of("errors"), "errors: ", first_error);
  Chain truth = robot.chain;
  for (const auto& [key, value] : errors->entries) {
    const Parameter* parameter = all.find(key);
    if (!parameter) return error("{}:{}: errors: no parameter of this robot is called \"{}\"", name, value.line, key);
    set_value_at(truth, parameter->at,
                 parameter->nominal + si_factor(parameter->quantity, scales) * reader.number(key));
  }
  if (first_error.any()) return forward_error(first_error.as_error());
  return truth;
}

}  // namespace kinfer
