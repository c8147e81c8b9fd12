// SPDX-License-Identifier: Apache-2.0
// Pose sets as CSV (docs/formats.md), and foreign files by a column map.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "kinfer/base/result.hpp"
#include "kinfer/io/pose_set/column_map.hpp"
#include "kinfer/io/pose_set/required_content.hpp"
#include "kinfer/io/text/units.hpp"
#include "kinfer/kinematics/chain.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer {

/// Reads a pose set for a robot: joint columns q1..qn or q_<name> of `chain` (unit by the joint's type), then what was
/// measured. PoseSet::targets are those of the chain where the file has columns of further targets.
Result<PoseSet> read_pose_set(const std::filesystem::path& path, const Chain& chain, const ColumnMap& map = {},
                              RequiredContent required = RequiredContent::measurements);
Result<PoseSet> parse_pose_set(std::string_view text, const std::string& name_in_messages, const Chain& chain,
                               const ColumnMap& map = {}, RequiredContent required = RequiredContent::measurements);

/// The same of a table that was split already.
Result<PoseSet> parse_pose_table(const CsvTable& table, const std::string& name_in_messages, const Chain& chain,
                                 const ColumnMap& map = {}, RequiredContent required = RequiredContent::measurements);

/// Pose set as CSV, lengths and angles in `units`, with full precision.
std::string format_pose_set_csv(const PoseSet& set, const Chain& chain, FileUnits units);

}  // namespace kinfer
