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

namespace kinfer {

/// Maps the columns of a foreign file to kinfer's (TOML): delimiter, decimal, skip_lines, [columns] ours = "theirs
/// [unit]", euler. With `euler`, the columns rx, ry, rz give the orientation in that sequence.
struct ColumnMap {
  char delimiter = ',';
  char decimal = '.';
  int skip_lines = 0;
  std::vector<std::pair<std::string, std::string>>
      columns;  ///< ours -> "theirs [unit]"; empty: the names in the file are ours
  std::optional<EulerSequence> euler;
};
Result<ColumnMap> read_column_map(const std::filesystem::path& path);
Result<ColumnMap> parse_column_map(std::string_view text, const std::string& name_in_messages);

}  // namespace kinfer
