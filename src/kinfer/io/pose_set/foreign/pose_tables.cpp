// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/pose_set/foreign/pose_tables.hpp"

#include <algorithm>
#include <array>

#include "kinfer/io/pose_set/foreign/joint_logs.hpp"
#include "kinfer/io/pose_set/foreign/tracker_file.hpp"

namespace kinfer {

std::span<const PoseTableFormat> pose_table_formats() {
  using enum PoseTableKind;
  // Lists of points have no header to be told by, and come last.
  static constexpr std::array formats{
      PoseTableFormat{"UR RTDE csv", joints, is_ur_rtde, read_ur_rtde},
      PoseTableFormat{"KUKA RSI telegrams", joints, is_kuka_rsi, read_kuka_rsi},
      PoseTableFormat{"OpenSim storage (.sto, .mot)", joints, is_opensim_storage, read_opensim_storage},
      PoseTableFormat{"OpenSim markers (.trc)", points, is_trc, read_trc},
      PoseTableFormat{"Qualisys tsv", points, is_qualisys, read_qualisys},
      PoseTableFormat{"OptiTrack Motive csv", points, is_motive, read_motive},
      PoseTableFormat{"SpatialAnalyzer text", points, is_spatial_analyzer, read_point_list},
      PoseTableFormat{"list of points", points, is_point_list, read_point_list},
  };
  return formats;
}

const PoseTableFormat* find_pose_table_format(std::string_view head) {
  const auto formats = pose_table_formats();
  const auto row = std::ranges::find_if(formats, [&](const PoseTableFormat& f) { return f.recognise(head); });
  return row == formats.end() ? nullptr : &*row;
}

}  // namespace kinfer
