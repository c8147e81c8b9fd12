// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/options/joint_columns.hpp"

#include <fmt/format.h>

#include "kinfer/io/files/text_file.hpp"
#include "kinfer/io/text/csv.hpp"
#include "kinfer/io/text/units.hpp"

namespace kinfer::cli {

std::vector<JointColumn> joint_columns(const std::string& path, const std::vector<std::string>& names) {
  std::vector<JointColumn> columns;
  for (std::size_t i = 0; i < names.size(); ++i) columns.push_back({fmt::format("q{}", i + 1), 1.0});
  const auto text = read_text_file(path);
  const auto header = text ? read_csv_header(*text, path) : Result<CsvHeader>(error("unreadable"));
  if (!header) return columns;
  for (std::size_t i = 0; i < names.size(); ++i)
    for (const std::string& cell : header->columns) {
      const ColumnHeader parts = parse_column_header(cell);
      if (parts.name != columns[i].header && parts.name != "q_" + names[i]) continue;
      const auto unit = find_unit(parts.unit);
      columns[i] = {cell, parts.has_unit && unit ? unit->factor : 1.0};
      break;
    }
  return columns;
}

}  // namespace kinfer::cli
