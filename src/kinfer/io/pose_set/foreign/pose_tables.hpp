// SPDX-License-Identifier: Apache-2.0
// Files of joint positions and of measured points as other programs write them, with several header lines or none: a
// table with one row per format, recognised by the beginning of the file. Each is read as a table with kinfer's
// columns.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "kinfer/io/pose_set/foreign/pose_table.hpp"

namespace kinfer {

enum class PoseTableKind { joints, points };

struct PoseTableFormat {
  std::string_view title;  ///< "Qualisys tsv"
  PoseTableKind kind = PoseTableKind::points;
  bool (*recognise)(std::string_view head) = nullptr;
  /// The table; with `choice` null the contents alone.
  Result<PoseTable> (*read)(std::string_view text, const std::string& name, const PoseTableChoice* choice) = nullptr;
};

/// The table: one row a format.
std::span<const PoseTableFormat> pose_table_formats();

/// The format of a file that begins so; null where none is recognised.
const PoseTableFormat* find_pose_table_format(std::string_view head);

}  // namespace kinfer
