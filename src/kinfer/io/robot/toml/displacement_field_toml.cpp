// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot/toml/displacement_field_toml.hpp"

#include <fmt/format.h>

namespace kinfer {
namespace {

using Eigen::Index;

/// The columns one below the other. Twelve digits: large coefficients of opposite sign nearly cancel.
std::string columns(ConstMatrixRef numbers) {
  std::string text;
  for (Index k = 0; k < numbers.cols(); ++k) {
    text += k == 0 ? "  " : ",\n  ";
    for (Index i = 0; i < numbers.rows(); ++i) text += fmt::format("{}{:.12g}", i == 0 ? "" : ", ", numbers(i, k));
  }
  return "[\n" + text + "\n]";
}

MatrixXd read_columns(TableReader& reader, std::string_view key, Index rows, Index count) {
  const std::vector<double> numbers = reader.numbers(key, static_cast<std::size_t>(rows * count));
  if (static_cast<Index>(numbers.size()) != rows * count) return MatrixXd::Zero(rows, count);
  return Eigen::Map<const MatrixXd>(numbers.data(), rows, count);
}

void expect_possible(TableReader& reader, std::string_view key, ConstMatrixRef numbers, const PossibleRange& range) {
  for (const double number : numbers.reshaped()) reader.expect_possible(key, number, range);
}

}  // namespace

std::string format_displacement_field_toml(const DisplacementField& field) {
  const std::string noise = field.noise > 0.0 ? fmt::format("noise = {:.7g}\n", field.noise) : std::string();
  return fmt::format("\n[displacement_field]\nsize = {:.7g}\n{}length = {}\npoints = {}\ncoefficients = {}\n",
                     field.size, noise, columns(field.length), columns(field.points), columns(field.coefficients));
}

DisplacementField read_displacement_field(TableReader& file, int dof, FirstError& first_error) {
  const TomlTable* table = file.table_or_none("displacement_field");
  if (!table) return {};
  TableReader reader(*table, file.line_of("displacement_field"), "displacement_field: ", first_error);
  DisplacementField field;
  field.size = reader.positive_or("size", 1e-4);
  reader.expect_possible("size", field.size, possible::length);
  field.noise = table->find("noise") ? reader.positive_or("noise", 0.0) : 0.0;
  field.length = read_columns(reader, "length", dof, 1);
  expect_possible(reader, "length", field.length, possible::length);
  if (!(field.length.array() > 0.0).all())
    reader.report_error(reader.line_of("length"), "\"length\": expected numbers above 0");
  const auto count = static_cast<Index>(reader.number_list("points").size()) / std::max(dof, 1);
  if (count == 0) reader.report_error(reader.line_of("points"), "\"points\": expected joint positions");
  field.points = read_columns(reader, "points", dof, count);
  expect_possible(reader, "points", field.points, possible::angle);
  field.coefficients = read_columns(reader, "coefficients", 3, count);
  expect_possible(reader, "coefficients", field.coefficients, possible::length);
  reader.expect_no_other_keys();
  return field;
}

}  // namespace kinfer
