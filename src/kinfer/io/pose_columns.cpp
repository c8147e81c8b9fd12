#include "kinfer/io/pose_columns.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kinfer {

bool VectorColumns::measured(std::size_t row) const {
  return !std::isnan(of[0][row]);
}

PoseColumns::PoseColumns(const CsvTable& table, const ColumnMap& map, Complaint& complaint)
    : table_(table), map_(map), complaint_(complaint) {
  map.columns.empty() ? use_own_names() : use_map();
}

void PoseColumns::use_own_names() {
  const auto& header = table_.header.columns;
  for (std::size_t place = 0; place < header.size(); ++place) {
    const Header ours = split_header(header[place]);
    columns_.push_back({std::string(ours.name), std::string(ours.unit), ours.has_unit, place, false});
  }
}

/// Where the column named `whole` is, or else the one whose name without its unit is the map's.
std::optional<std::size_t> PoseColumns::place_of(const Header& theirs, std::string_view whole) {
  const auto& header = table_.header.columns;
  std::vector<std::size_t> exact, by_name;
  for (std::size_t place = 0; place < header.size(); ++place) {
    if (header[place] == whole) exact.push_back(place);
    if (split_header(header[place]).name == theirs.name) by_name.push_back(place);
  }
  const auto& found = exact.empty() ? by_name : exact;
  if (found.empty())
    complain_about_header(fmt::format("no column is named \"{}\", which the column map wants", theirs.name));
  if (found.size() > 1) complain_about_header(fmt::format("column {} appears twice", theirs.name));
  return found.size() == 1 ? std::optional(found.front()) : std::nullopt;
}

void PoseColumns::use_map() {
  for (const auto& [ours, whole] : map_.columns) {
    const Header theirs = split_header(whole);
    const auto place = place_of(theirs, whole);
    if (!place) continue;
    Column column{ours, std::string(theirs.unit), theirs.has_unit, *place, false};
    const Header in_file = split_header(table_.header.columns[*place]);
    if (in_file.has_unit && column.has_unit && in_file.unit != column.unit)
      complain_about_header(
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
  complain_about_header(
      fmt::format("column {}: expected {}, found the unit \"{}\"", column.name, describe(dimension), column.unit));
  return {};
}

double PoseColumns::number(const Column& column, const Unit& unit, std::size_t row) {
  const std::string_view cell = table_.cell(row, column.place);
  if (cell.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto value = parse_number(cell, map_.decimal);
  if (!value) complain(row, not_a_number(column.name, cell, map_.decimal));
  if (value && !std::isfinite(*value))
    complain(row, fmt::format("column {}: expected a finite number, found \"{}\"", column.name, cell));
  return value ? unit.factor * (*value + unit.offset) : 0.0;
}

std::optional<NumberColumn> PoseColumns::numbers(std::string_view name, Dimension dimension) {
  const Column* column = take(name);
  if (!column) return std::nullopt;
  const Unit unit = unit_of(*column, dimension);
  NumberColumn values(rows());
  for (std::size_t row = 0; row < rows(); ++row) values[row] = number(*column, unit, row);
  return values;
}

/// x[mm], y[m] is a slip of the pen, not a wish.
void PoseColumns::expect_one_unit(const std::array<std::string, 3>& names) {
  const Column* first = find(names[0]);
  for (const std::string& name : names) {
    const Column* column = find(name);
    if (column->unit == first->unit) continue;
    const auto said = [](const Column& c) { return c.has_unit ? "in " + c.unit : std::string("without a unit"); };
    complain_about_header(
        fmt::format("column {} is {}, but column {} is {}", first->name, said(*first), name, said(*column)));
  }
}

std::optional<VectorColumns> PoseColumns::vectors(const std::array<std::string, 3>& names, Dimension dimension) {
  const auto missing = std::find_if(names.begin(), names.end(), [&](const auto& name) { return !has(name); });
  const auto present = std::find_if(names.begin(), names.end(), [&](const auto& name) { return has(name); });
  if (present == names.end()) return std::nullopt;
  if (missing != names.end()) {
    complain_about_header(fmt::format("column {} is missing beside column {}", *missing, *present));
    return std::nullopt;
  }
  expect_one_unit(names);
  VectorColumns vectors{{*numbers(names[0], dimension), *numbers(names[1], dimension), *numbers(names[2], dimension)}};
  for (std::size_t row = 0; row < rows(); ++row) {
    const auto given =
        std::count_if(vectors.of.begin(), vectors.of.end(), [&](const auto& c) { return !std::isnan(c[row]); });
    if (given == 1 || given == 2)
      complain(row,
               fmt::format("expected {}, {} and {} or none of them, found {}", names[0], names[1], names[2], given));
  }
  return vectors;
}

std::optional<std::vector<std::string>> PoseColumns::texts(std::string_view name) {
  const Column* column = take(name);
  if (!column) return std::nullopt;
  std::vector<std::string> cells(rows());
  for (std::size_t row = 0; row < rows(); ++row) cells[row] = table_.cell(row, column->place);
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
    if (!column.taken) complain_about_header(fmt::format("unknown column \"{}\"", column.name));
}

}  // namespace kinfer
