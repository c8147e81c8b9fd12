// SPDX-License-Identifier: Apache-2.0
// What a tracker's file holds, whatever the maker: rows of cells, and where in them each marker's position stands.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "kinfer/io/pose_set/foreign/foreign_rows.hpp"
#include "kinfer/io/pose_set/foreign/pose_table.hpp"

namespace kinfer {

struct TrackedMarker {
  std::string name{};
  bool is_body = false;                                    ///< a rigid body: chosen before its markers
  std::array<std::size_t, 3> position{};                   ///< columns
  std::optional<std::array<std::size_t, 4>> quaternion{};  ///< columns of w, x, y, z
};

struct TrackerFile {
  ForeignRows rows;
  std::vector<TrackedMarker> markers{};
  std::string length_unit{};           ///< of kinfer's units
  double length_factor = 1.0;          ///< `length_unit` per unit of the file
  std::optional<std::size_t> time{};   ///< column [s]
  double rate = 0.0;                   ///< [Hz] of rows without times; 0: unknown
  std::optional<std::size_t> name{};   ///< column of names
  bool has_zeros_for_missing = false;  ///< 0, 0, 0 is no position
  char decimal = '.';
  std::vector<std::string> remarks{};
};

/// Columns id, t, x, y, z and qw … of one marker; rows without its position are left out.
Result<PoseTable> marker_table(TrackerFile file, const std::string& name, const PoseTableChoice* choice);

/// Formats of trackers, each in a source of its own.
bool is_trc(std::string_view head);
Result<PoseTable> read_trc(std::string_view text, const std::string& name, const PoseTableChoice* choice);
bool is_qualisys(std::string_view head);
Result<PoseTable> read_qualisys(std::string_view text, const std::string& name, const PoseTableChoice* choice);
bool is_motive(std::string_view head);
Result<PoseTable> read_motive(std::string_view text, const std::string& name, const PoseTableChoice* choice);
bool is_spatial_analyzer(std::string_view head);
bool is_point_list(std::string_view head);
Result<PoseTable> read_point_list(std::string_view text, const std::string& name, const PoseTableChoice* choice);

}  // namespace kinfer
