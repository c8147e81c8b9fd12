// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/pose_set/pose_columns.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinfer/io/text/csv_text.hpp"
#include "kinfer/io/text/possible_range.hpp"

namespace kinfer {

bool VectorColumns::measured(std::size_t row) const {
  return !std::isnan(of[0][row]);
}

PoseColumns::PoseColumns(const CsvTable& table, const ColumnMap& map, FirstError& first_error)
    : table_(table), map_(map), first_error_(first_error) {
  map.columns.empty() ? use_header_names() : apply_map();
}

void PoseColumns::use_header_names() {
  const auto& header = table_.header.columns;
  for (std::size_t index = 0; index < header.size(); ++index) {
    const ColumnHeader ours = parse_column_header(header[index]);
    columns_.push_back({std::string(ours.name), std::string(ours.unit), ours.has_unit, index, false});
  }
}

/// Index of the column whose header is `whole`, else of the one whose name without unit is that of `theirs`.
std::optional<std::size_t> PoseColumns::index_of(const ColumnHeader& theirs, std::string_view full_header) {
  const auto& header = table_.header.columns;
  std::vector<std::size_t> exact, by_name;
  for (std::size_t index = 0; index < header.size(); ++index) {
    if (header[index] == full_header) exact.push_back(index);
    if (parse_column_header(header[index]).name == theirs.name) by_name.push_back(index);
  }
  const auto& found = exact.empty() ? by_name : exact;
  if (found.empty())
    report_header_error(fmt::format("no column is named \"{}\", which the column map wants", theirs.name));
  if (found.size() > 1) report_header_error(fmt::format("column {} appears twice", theirs.name));
  return found.size() == 1 ? std::optional(found.front()) : std::nullopt;
}

void PoseColumns::apply_map() {
  for (const auto& [ours, full_header] : map_.columns) {
    const ColumnHeader theirs = parse_column_header(full_header);
    const auto index = index_of(theirs, full_header);
    if (!index) continue;
    Column column{ours, std::string(theirs.unit), theirs.has_unit, *index, false};
    const ColumnHeader in_file = parse_column_header(table_.header.columns[*index]);
    if (in_file.has_unit && column.has_unit && in_file.unit != column.unit)
      report_header_error(
          fmt::format("column {} is in {}, but the column map says {}", in_file.name, in_file.unit, column.unit));
    if (!column.has_unit) column.unit = in_file.unit, column.has_unit = in_file.has_unit;
    columns_.push_back(std::move(column));
  }
}

std::vector<std::string_view> PoseColumns::names() const {
  std::vector<std::string_view> names;
  for (const Column& column : columns_) names.push_back(column.name);
  return names;
}

std::vector<std::string_view> PoseColumns::untaken_names() const {
  std::vector<std::string_view> names;
  for (const Column& column : columns_)
    if (!column.taken) names.push_back(column.name);
  return names;
}

const PoseColumns::Column* PoseColumns::find(std::string_view name) const {
  const auto found = std::find_if(columns_.begin(), columns_.end(), [&](const Column& c) { return c.name == name; });
  return found == columns_.end() ? nullptr : &*found;
}

PoseColumns::Column* PoseColumns::take(std::string_view name) {
  auto* column = const_cast<Column*>(find(name));
  if (column) column->taken = true;
  return column;
}

Unit PoseColumns::unit_of(const Column& column, Dimension dimension) {
  if (!column.has_unit) return {dimension, 1.0, 0.0};
  const auto unit = find_unit(column.unit);
  if (unit && unit->dimension == dimension) return *unit;
  report_header_error(
      fmt::format("column {}: expected {}, found the unit \"{}\"", column.name, describe(dimension), column.unit));
  return {};
}

double PoseColumns::number(const Column& column, const Unit& unit, std::size_t row) {
  const std::string_view cell = table_.cell(row, column.index);
  if (cell.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto value = parse_number(cell, table_.header.decimal);
  if (!value) report_error(row, describe_invalid_number(column.name, cell, table_.header.decimal));
  if (value && !std::isfinite(*value))
    report_error(row, fmt::format("column {}: expected a finite number, found \"{}\"", column.name, cell));
  const double si = value ? unit.factor * (*value + unit.offset) : 0.0;
  if (std::isfinite(si))
    if (const auto what = impossible(si, possible_range(unit.dimension)))
      report_error(row, fmt::format("column {}: {}", column.name, *what));
  return si;
}

std::optional<NumberColumn> PoseColumns::numbers(std::string_view name, Dimension dimension) {
  const Column* column = take(name);
  if (!column) return std::nullopt;
  const Unit unit = unit_of(*column, dimension);
  NumberColumn values(rows());
  for (std::size_t row = 0; row < rows(); ++row) values[row] = number(*column, unit, row);
  return values;
}

/// Mixed units such as x[mm], y[m] are taken as a typing mistake.
void PoseColumns::expect_one_unit(const std::array<std::string, 3>& names) {
  const Column* first = find(names[0]);
  for (const std::string& name : names) {
    const Column* column = find(name);
    if (column->unit == first->unit) continue;
    const auto describe_column_unit = [](const Column& c) {
      return c.has_unit ? "in " + c.unit : std::string("without a unit");
    };
    report_header_error(fmt::format("column {} is {}, but column {} is {}", first->name, describe_column_unit(*first),
                                    name, describe_column_unit(*column)));
  }
}

std::optional<VectorColumns> PoseColumns::vectors(const std::array<std::string, 3>& names, Dimension dimension) {
  const auto missing = std::find_if(names.begin(), names.end(), [&](const auto& name) { return !has(name); });
  const auto present = std::find_if(names.begin(), names.end(), [&](const auto& name) { return has(name); });
  if (present == names.end()) return std::nullopt;
  if (missing != names.end()) {
    report_header_error(fmt::format("column {} is missing beside column {}", *missing, *present));
    return std::nullopt;
  }
  expect_one_unit(names);
  VectorColumns vectors{{*numbers(names[0], dimension), *numbers(names[1], dimension), *numbers(names[2], dimension)}};
  for (std::size_t row = 0; row < rows(); ++row) {
    const auto given =
        std::count_if(vectors.of.begin(), vectors.of.end(), [&](const auto& c) { return !std::isnan(c[row]); });
    if (given == 1 || given == 2)
      report_error(
          row, fmt::format("expected {}, {} and {} or none of them, found {}", names[0], names[1], names[2], given));
  }
  return vectors;
}

std::optional<std::vector<std::string>> PoseColumns::texts(std::string_view name) {
  const Column* column = take(name);
  if (!column) return std::nullopt;
  std::vector<std::string> cells(rows());
  for (std::size_t row = 0; row < rows(); ++row) cells[row] = without_formula_guard(table_.cell(row, column->index));
  return cells;
}

std::optional<NameColumn> PoseColumns::name_indices(std::string_view name) {
  const auto cells = texts(name);
  if (!cells) return std::nullopt;
  NameColumn column;
  for (const std::string& cell : *cells) {
    const auto known = std::find(column.names.begin(), column.names.end(), cell);
    column.index.push_back(cell.empty() ? -1 : static_cast<int>(known - column.names.begin()));
    if (!cell.empty() && known == column.names.end()) column.names.push_back(cell);
  }
  return column;
}

void PoseColumns::expect_all_taken() {
  for (const Column& column : columns_)
    if (!column.taken) report_header_error(fmt::format("unknown column \"{}\"", column.name));
}

}  // namespace kinfer
