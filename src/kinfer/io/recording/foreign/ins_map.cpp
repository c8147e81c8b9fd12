// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/recording/foreign/ins_map.hpp"

#include <algorithm>

#include "kinfer/io/files/text_file.hpp"
#include "kinfer/io/text/table_format.hpp"
#include "kinfer/io/text/toml_reader.hpp"

namespace kinfer {
namespace {

/// Texts separated by "|": TOML arrays of texts are not what the table reader reads.
std::vector<std::string> split_texts(const std::string& text) {
  std::vector<std::string> parts;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('|', at), text.size());
    parts.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return parts;
}

InsClock read_clock(TableReader& file, const char* key, FirstError& first_error) {
  InsClock clock;
  const TomlTable* table = file.table_or_none(key);
  if (!table) return clock;
  TableReader reader(*table, file.line_of(key), fmt::format("{}: ", key), first_error);
  clock.column = reader.text_or("column", "");
  clock.rate_from = reader.text_or("rate_from", "");
  if (reader.has("tick")) clock.tick = reader.positive_or("tick", 0.0);
  if (reader.has("rate")) clock.tick = 1.0 / reader.positive_or("rate", 1.0);
  if (reader.has("wraps")) clock.wraps = reader.positive_or("wraps", 0.0);
  for (const char* optional : {"tick", "rate", "wraps"}) reader.ignore(optional);
  reader.expect_no_other_keys();
  return clock;
}

/// ["-x", "y", "z"] as text "-x y z": a permutation with signs.
std::optional<Mat3> parse_axes(const std::array<std::string, 3>& axes) {
  Mat3 map = Mat3::Zero();
  for (int row = 0; row < 3; ++row) {
    std::string_view axis = axes[static_cast<std::size_t>(row)];
    const bool negative = axis.starts_with('-');
    if (negative || axis.starts_with('+')) axis.remove_prefix(1);
    if (axis.size() != 1 || axis[0] < 'x' || axis[0] > 'z') return std::nullopt;
    map(row, axis[0] - 'x') = negative ? -1.0 : 1.0;
  }
  if (!((map * map.transpose() - Mat3::Identity()).cwiseAbs().maxCoeff() < 0.5)) return std::nullopt;
  return map;
}

void read_axes(const TomlTable& table, TableReader& file, InsMap& map) {
  file.ignore("axes");
  const TomlValue* value = table.find("axes");
  if (!value) return;
  std::array<std::string, 3> texts;
  const auto* array = std::get_if<TomlArray>(&value->value);
  const bool is_triple = array && array->size() == 3 && std::ranges::all_of(*array, [](const TomlValue& v) {
                           return std::holds_alternative<std::string>(v.value);
                         });
  if (is_triple)
    for (std::size_t k = 0; k < 3; ++k) texts[k] = std::get<std::string>((*array)[k].value);
  const auto axes = is_triple ? parse_axes(texts) : std::nullopt;
  if (axes)
    map.axes = *axes;
  else
    file.report_error(value->line, "\"axes\": expected three different axes as [\"-x\", \"y\", \"z\"]");
}

void read_signs(TableReader& file, FirstError& first_error, InsMap& map) {
  const TomlTable* table = file.table_or_none("sign");
  if (!table) return;
  TableReader reader(*table, file.line_of("sign"), "sign: ", first_error);
  constexpr std::array names{"force", "rate", "field"};
  for (std::size_t i = 0; i < 3; ++i) {
    map.sign[i] = reader.number_or(names[i], 1.0);
    if (!(map.sign[i] == 1.0 || map.sign[i] == -1.0)) reader.report_error(reader.line_of(names[i]), "expected 1 or -1");
  }
  reader.expect_no_other_keys();
}

void read_units(TableReader& file, FirstError& first_error, InsMap& map) {
  const TomlTable* table = file.table_or_none("units");
  if (!table) return;
  TableReader reader(*table, file.line_of("units"), "units: ", first_error);
  constexpr std::array names{"force", "rate", "field"};
  for (std::size_t i = 0; i < 3; ++i) map.units[i] = reader.text_or(names[i], "");
  reader.expect_no_other_keys();
}

}  // namespace

Result<InsMap> parse_ins_map(std::string_view text, const std::string& name) {
  KINFER_TRY(table, parse_toml(text, name));
  FirstError first_error(name);
  TableReader file(table, 1, "", first_error);
  InsMap map;
  map.title = file.text_or("title", "");
  map.recognise = split_texts(file.text_or("recognise", ""));
  map.unlike = file.text_or("unlike", "");
  map.file_word = file.text_or("file", "");
  map.refuse = file.text_or("refuse", "");
  map.format = read_table_format(file);
  map.sensor = file.text_or("sensor", "");
  map.clock = read_clock(file, "clock", first_error);
  map.counter = read_clock(file, "counter", first_error);
  if (const TomlTable* columns = file.table_or_none("columns")) {
    TableReader reader(*columns, file.line_of("columns"), "columns: ", first_error);
    for (const auto& entry : columns->entries) map.columns.emplace_back(entry.key, reader.text(entry.key));
  }
  read_signs(file, first_error, map);
  read_axes(table, file, map);
  read_units(file, first_error, map);
  file.expect_no_other_keys();
  if (first_error.any()) return forward_error(first_error.as_error());
  return map;
}

Result<InsMap> read_ins_map(const std::filesystem::path& path) {
  KINFER_TRY(text, read_text_file(path));
  return parse_ins_map(text, path.string());
}

}  // namespace kinfer
