// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/text/toml_reader.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <cmath>

#include "kinfer/io/text/possible_range.hpp"

namespace kinfer {
namespace {

TomlTable to_plain(const toml::table& table);

TomlValue to_plain(const toml::node& node) {
  TomlValue value;
  value.line = static_cast<int>(node.source().begin.line);
  if (const auto* flag = node.as_boolean()) value.value = flag->get();
  if (const auto* whole = node.as_integer()) value.value = static_cast<double>(whole->get());
  if (const auto* real = node.as_floating_point()) value.value = real->get();
  if (const auto* text = node.as_string()) value.value = text->get();
  if (const auto* table = node.as_table()) value.value = to_plain(*table);
  if (const auto* array = node.as_array()) {
    TomlArray items;
    for (const toml::node& item : *array) items.push_back(to_plain(item));
    value.value = std::move(items);
  }
  return value;
}

/// The library sorts keys by name; the position in the file restores the original order.
TomlTable to_plain(const toml::table& table) {
  struct PositionedEntry {
    toml::source_position position;
    TomlEntry entry;
  };
  std::vector<PositionedEntry> positioned_entries;
  for (const auto& [key, node] : table)
    positioned_entries.push_back({key.source().begin, {std::string(key.str()), to_plain(node)}});
  std::stable_sort(positioned_entries.begin(), positioned_entries.end(),
                   [](const PositionedEntry& a, const PositionedEntry& b) { return a.position < b.position; });
  TomlTable result;
  for (PositionedEntry& item : positioned_entries) result.entries.push_back(std::move(item.entry));
  return result;
}

std::string type_name(const TomlValue& value) {
  constexpr const char* names[] = {"a date", "true or false", "a number", "a text", "a list", "a table"};
  return names[value.value.index()];
}

}  // namespace

const TomlValue* TomlTable::find(std::string_view key) const {
  for (const TomlEntry& entry : entries)
    if (entry.key == key) return &entry.value;
  return nullptr;
}

Result<TomlTable> parse_toml(std::string_view text, const std::string& name) {
  try {
    return to_plain(toml::parse(text));
  } catch (const toml::parse_error& failure) {
    return error("{}:{}: not TOML: {}", name, failure.source().begin.line, failure.description());
  }
}

TableReader::TableReader(const TomlTable& table, int line, std::string prefix, FirstError& first_error)
    : table_(table), line_(line), prefix_(std::move(prefix)), first_error_(first_error) {}

int TableReader::line_of(std::string_view key) const {
  const TomlValue* value = table_.find(key);
  return value ? value->line : line_;
}

const TomlValue* TableReader::lookup(std::string_view key) {
  read_keys_.emplace_back(key);
  return table_.find(key);
}

const TomlValue* TableReader::require(std::string_view key, std::string_view expected) {
  const TomlValue* value = lookup(key);
  if (!value) report_error(line_, fmt::format("\"{}\" is missing, expected {}", key, expected));
  return value;
}

void TableReader::wrong_type(const TomlValue& value, std::string_view key, std::string_view expected) const {
  report_error(value.line, fmt::format("\"{}\": expected {}, found {}", key, expected, type_name(value)));
}

double TableReader::finite(const TomlValue& value, std::string_view key) const {
  const double* number = std::get_if<double>(&value.value);
  if (!number) wrong_type(value, key, "a number");
  if (number && !std::isfinite(*number)) report_error(value.line, fmt::format("\"{}\": expected a finite number", key));
  if (number && std::isfinite(*number))
    if (const auto what = impossible(*number, possible::number))
      report_error(value.line, fmt::format("\"{}\": {}", key, *what));
  return number && std::isfinite(*number) ? *number : 0.0;
}

double TableReader::number(std::string_view key) {
  const TomlValue* value = require(key, "a number");
  return value ? finite(*value, key) : 0.0;
}

double TableReader::number_or(std::string_view key, double fallback) {
  const TomlValue* value = lookup(key);
  return value ? finite(*value, key) : fallback;
}

double TableReader::positive_or(std::string_view key, double fallback) {
  const double value = number_or(key, fallback);
  if (has(key) && value <= 0.0) report_error(line_of(key), fmt::format("\"{}\": expected a number above 0", key));
  return value;
}

void TableReader::expect_possible(std::string_view key, double value, const PossibleRange& range) const {
  if (const auto what = impossible(value, range)) report_error(line_of(key), fmt::format("\"{}\": {}", key, *what));
}

std::string TableReader::text(std::string_view key) {
  const TomlValue* value = require(key, "a text");
  if (!value) return {};
  if (const auto* found = std::get_if<std::string>(&value->value)) return *found;
  wrong_type(*value, key, "a text");
  return {};
}

std::string TableReader::text_or(std::string_view key, const std::string& fallback) {
  return has(key) ? text(key) : (lookup(key), fallback);
}

bool TableReader::flag_or(std::string_view key, bool fallback) {
  const TomlValue* value = lookup(key);
  if (!value) return fallback;
  if (const auto* found = std::get_if<bool>(&value->value)) return *found;
  wrong_type(*value, key, "true or false");
  return fallback;
}

Vec3 TableReader::read_vector(const TomlValue& value, std::string_view key) const {
  const TomlArray* items = std::get_if<TomlArray>(&value.value);
  if (!items) {
    wrong_type(value, key, "a list of 3 numbers");
    return Vec3::Zero();
  }
  if (items->size() != 3) {
    report_error(value.line, fmt::format("\"{}\": expected 3 numbers, found {}", key, items->size()));
    return Vec3::Zero();
  }
  return {finite((*items)[0], key), finite((*items)[1], key), finite((*items)[2], key)};
}

Vec3 TableReader::vector(std::string_view key) {
  const TomlValue* value = require(key, "a list of 3 numbers");
  return value ? read_vector(*value, key) : Vec3(Vec3::Zero());
}

Vec3 TableReader::vector_or(std::string_view key, const Vec3& fallback) {
  const TomlValue* value = lookup(key);
  return value ? read_vector(*value, key) : fallback;
}

std::vector<double> TableReader::numbers(std::string_view key, std::size_t count) {
  std::vector<double> found(count, 0.0);
  const TomlValue* value = require(key, fmt::format("a list of {} numbers", count));
  if (!value) return found;
  const TomlArray* items = std::get_if<TomlArray>(&value->value);
  if (!items) {
    wrong_type(*value, key, fmt::format("a list of {} numbers", count));
    return found;
  }
  if (items->size() != count)
    report_error(value->line, fmt::format("\"{}\": expected {} numbers, found {}", key, count, items->size()));
  for (std::size_t i = 0; i < std::min(count, items->size()); ++i) {
    const double* number = std::get_if<double>(&(*items)[i].value);
    if (!number) wrong_type((*items)[i], key, "a number");
    if (number && std::isnan(*number))
      report_error(value->line, fmt::format("\"{}\": expected numbers, found nan", key));
    if (number) found[i] = *number;
  }
  return found;
}

std::vector<double> TableReader::number_list(std::string_view key) {
  std::vector<double> found;
  const TomlValue* value = require(key, "a list of numbers");
  if (!value) return found;
  const TomlArray* items = std::get_if<TomlArray>(&value->value);
  if (!items) wrong_type(*value, key, "a list of numbers");
  if (items)
    for (const TomlValue& item : *items) found.push_back(finite(item, key));
  return found;
}

std::vector<Vec3> TableReader::vectors_or_none(std::string_view key) {
  std::vector<Vec3> found;
  const TomlValue* value = lookup(key);
  if (!value) return found;
  const TomlArray* items = std::get_if<TomlArray>(&value->value);
  if (!items) wrong_type(*value, key, "a list of points, each 3 numbers");
  if (items)
    for (const TomlValue& item : *items) found.push_back(read_vector(item, key));
  return found;
}

const TomlTable* TableReader::table_or_none(std::string_view key) {
  const TomlValue* value = lookup(key);
  if (!value) return nullptr;
  const TomlTable* table = std::get_if<TomlTable>(&value->value);
  if (!table) wrong_type(*value, key, "a table");
  return table;
}

std::vector<std::pair<const TomlTable*, int>> TableReader::tables_or_none(std::string_view key) {
  std::vector<std::pair<const TomlTable*, int>> tables;
  const TomlValue* value = lookup(key);
  if (!value) return tables;
  const TomlArray* items = std::get_if<TomlArray>(&value->value);
  if (!items) {
    wrong_type(*value, key, fmt::format("[[{}]] tables", key));
    return tables;
  }
  for (const TomlValue& item : *items) {
    if (const auto* table = std::get_if<TomlTable>(&item.value))
      tables.emplace_back(table, item.line);
    else
      wrong_type(item, key, fmt::format("[[{}]] tables", key));
  }
  return tables;
}

void TableReader::expect_no_other_keys() const {
  for (const auto& [key, value] : table_.entries)
    if (std::find(read_keys_.begin(), read_keys_.end(), key) == read_keys_.end())
      report_error(value.line, fmt::format("unknown key \"{}\"", key));
}

}  // namespace kinfer
