// SPDX-License-Identifier: Apache-2.0
// Column maps: which columns of a foreign pose-set file hold what, and in which units.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/geometry/rotation.hpp"
#include "kinfer/io/text/csv.hpp"

namespace kinfer {

/// Maps the columns of a foreign file to kinfer's (TOML): delimiter, decimal, skip_lines, comment, header, [columns]
/// ours = "theirs [unit]" (or "#3 [unit]" by number), euler. With `euler`, the columns rx, ry, rz give the orientation
/// in that sequence, or as rotation vector.
struct ColumnMap {
  CsvFormat format{automatic, automatic};
  std::vector<std::pair<std::string, std::string>>
      columns;  ///< ours -> "theirs [unit]"; empty: the names in the file are ours
  std::optional<EulerSequence> euler;
  bool is_rotation_vector = false;  ///< rx, ry, rz are an axis times an angle; euler = "rotation vector"
};
Result<ColumnMap> read_column_map(const std::filesystem::path& path);
Result<ColumnMap> parse_column_map(std::string_view text, const std::string& name_in_messages);

}  // namespace kinfer
