// Pose sets as CSV (docs/formats.md), and foreign files by a column map.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/geometry/rotation.hpp"
#include "kinfer/io/units.hpp"
#include "kinfer/kinematics/chain.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer {

/// How a foreign file maps to ours (TOML): delimiter, decimal, skip_lines, [columns] ours = "theirs [unit]", euler.
/// With `euler`, the columns rx, ry, rz give the orientation in that sequence.
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

/// What must be in the file besides the joint readings. `joints_only`, for prediction: nothing; a row with an anchor
/// but no distance then has NaN for its distance. `targets`, for compensation: the tool points that are wanted, with or
/// without readings to start from (PoseSet::joints then has no rows).
enum class Expect { measurements, joints_only, targets };

/// Reads a pose set for a robot: joint columns q1..qn or q_<name> of `chain` (unit by the joint's type), then what was
/// measured. PoseSet::targets are those of the chain where the file has columns of further targets.
Result<PoseSet> read_pose_set(const std::filesystem::path& path, const Chain& chain, const ColumnMap& map = {},
                              Expect expect = Expect::measurements);
Result<PoseSet> parse_pose_set(std::string_view text, const std::string& name_in_messages, const Chain& chain,
                               const ColumnMap& map = {}, Expect expect = Expect::measurements);

/// Pose set as CSV, in the units that `units` names for lengths and angles; all digits.
std::string pose_set_csv(const PoseSet& set, const Chain& chain, FileUnits units);

}  // namespace kinfer
