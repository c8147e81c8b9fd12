// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/pose_set/column_map.hpp"

#include "kinfer/io/text/text_file.hpp"
#include "kinfer/io/text/toml_reader.hpp"

namespace kinfer {
namespace {

char read_character(TableReader& file, std::string_view key, char fallback) {
  std::string text = file.text_or(key, std::string(1, fallback));
  if (text == "tab") text = "\t";
  if (text.size() == 1) return text.front();
  file.report_error(file.line_of(key), fmt::format("\"{}\": expected one character, found \"{}\"", key, text));
  return fallback;
}

int read_skip_lines(TableReader& file) {
  const double lines = file.number_or("skip_lines", 0.0);
  if (lines >= 0 && lines <= 1e6 && lines == static_cast<int>(lines)) return static_cast<int>(lines);
  file.report_error(file.line_of("skip_lines"), "\"skip_lines\": expected a whole number from 0");
  return 0;
}

std::optional<EulerSequence> read_euler(TableReader& file) {
  if (!file.has("euler")) return file.ignore("euler"), std::nullopt;
  const std::string text = file.text("euler");
  const auto sequence = parse_euler_sequence(text);
  if (!sequence)
    file.report_error(
        file.line_of("euler"),
        fmt::format("\"euler\": expected a sequence as \"XYZ intrinsic\" or \"ZYX extrinsic\", found \"{}\"", text));
  return sequence;
}

}  // namespace

Result<ColumnMap> parse_column_map(std::string_view text, const std::string& name) {
  KINFER_TRY(table, parse_toml(text, name));
  FirstError first_error(name);
  TableReader file(table, 1, "", first_error);
  ColumnMap map;
  map.delimiter = read_character(file, "delimiter", map.delimiter);
  map.decimal = read_character(file, "decimal", map.decimal);
  if (map.decimal != '.' && map.decimal != ',')
    file.report_error(file.line_of("decimal"), "\"decimal\": expected \".\" or \",\"");
  if (map.decimal == map.delimiter)
    file.report_error(file.line_of("decimal"), "\"decimal\" and \"delimiter\" are the same character");
  map.skip_lines = read_skip_lines(file);
  map.euler = read_euler(file);
  if (const TomlTable* columns = file.table_or_none("columns")) {
    TableReader reader(*columns, file.line_of("columns"), "columns: ", first_error);
    for (const auto& [ours, theirs] : columns->entries) map.columns.emplace_back(ours, reader.text(ours));
  }
  file.expect_no_other_keys();
  if (first_error.any()) return forward_error(first_error.as_error());
  return map;
}

Result<ColumnMap> read_column_map(const std::filesystem::path& path) {
  KINFER_TRY(text, read_text_file(path));
  return parse_column_map(text, path.string());
}

}  // namespace kinfer
