// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/pose_set/column_map.hpp"

#include "kinfer/io/files/text_file.hpp"
#include "kinfer/io/text/table_format.hpp"
#include "kinfer/io/text/toml_reader.hpp"

namespace kinfer {
namespace {

void read_euler(TableReader& file, ColumnMap& map) {
  if (!file.has("euler")) return file.ignore("euler");
  const std::string text = file.text("euler");
  map.is_rotation_vector = text == "rotation vector";
  if (map.is_rotation_vector) return;
  map.euler = parse_euler_sequence(text);
  if (!map.euler)
    file.report_error(
        file.line_of("euler"),
        fmt::format("\"euler\": expected a sequence as \"XYZ intrinsic\" or \"ZYX extrinsic\", found \"{}\"", text));
}

}  // namespace

Result<ColumnMap> parse_column_map(std::string_view text, const std::string& name) {
  KINFER_TRY(table, parse_toml(text, name));
  FirstError first_error(name);
  TableReader file(table, 1, "", first_error);
  ColumnMap map;
  map.format = read_table_format(file);
  read_euler(file, map);
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
