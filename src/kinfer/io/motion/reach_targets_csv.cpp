// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/motion/reach_targets_csv.hpp"

#include <cmath>
#include <numbers>

#include "kinfer/io/files/text_file.hpp"
#include "kinfer/io/pose_set/pose_columns.hpp"
#include "kinfer/io/pose_set/pose_set_csv.hpp"
#include "kinfer/io/text/csv.hpp"
#include "kinfer/io/text/first_error.hpp"
#include "kinfer/io/text/format_number.hpp"

namespace kinfer {
namespace {

constexpr double unit_length_tolerance = 1e-3;  // [1] of a direction written with four digits or more

void set_orientation(PoseColumns& columns, std::size_t row, const OrientationGoal& goal, ReachTarget& target) {
  if (!std::holds_alternative<FreeOrientation>(target.orientation))
    return columns.report_error(row, "expected one of qw,qx,qy,qz, axis_i,axis_j,axis_k and pitch, found two");
  target.orientation = goal;
}

void read_axes(PoseColumns& columns, std::vector<ReachTarget>& targets) {
  const auto axes = columns.vectors({"axis_i", "axis_j", "axis_k"}, Dimension::one);
  if (!axes) return;
  for (std::size_t row = 0; row < targets.size(); ++row) {
    if (!axes->measured(row)) continue;
    const Vec3 axis = axes->at(row);
    if (std::abs(axis.norm() - 1.0) > unit_length_tolerance)
      columns.report_error(row,
                           fmt::format("axis_i, axis_j, axis_k: expected a length of 1, found {:.4g}", axis.norm()));
    else
      set_orientation(columns, row, AxisGoal{axis.normalized()}, targets[row]);
  }
}

void read_pitches(PoseColumns& columns, std::vector<ReachTarget>& targets) {
  const auto pitches = columns.numbers("pitch", Dimension::angle);
  if (!pitches) return;
  for (std::size_t row = 0; row < targets.size(); ++row) {
    const double pitch = (*pitches)[row];
    if (std::isnan(pitch)) continue;
    if (std::abs(pitch) > 0.5 * std::numbers::pi)
      columns.report_error(row, "column pitch: expected -90 to 90 deg above the horizontal plane");
    else
      set_orientation(columns, row, PitchGoal{pitch}, targets[row]);
  }
}

}  // namespace

Result<ReachTargets> parse_reach_targets(std::string_view text, const std::string& name, const Chain& chain,
                                         const ColumnMap& map) {
  KINFER_TRY(set, parse_pose_set(text, name, chain, map, RequiredContent::targets));
  ReachTargets read{std::vector<ReachTarget>(static_cast<std::size_t>(set.rows())),
                    set.joints.rows() > 0 ? set.joints : MatrixXd()};
  for (const PointMeasurement& point : set.points)
    read.targets[static_cast<std::size_t>(point.row)].position = point.position;
  for (const OrientationMeasurement& m : set.orientations)
    read.targets[static_cast<std::size_t>(m.row)].orientation = FullGoal{m.orientation.toRotationMatrix()};
  KINFER_TRY(table, split_csv(text, name, map.format));
  FirstError first_error(name);
  PoseColumns columns(table, map, first_error);
  read_axes(columns, read.targets);
  read_pitches(columns, read.targets);
  if (first_error.any()) return forward_error(first_error.as_error());
  return read;
}

Result<ReachTargets> read_reach_targets(const std::filesystem::path& path, const Chain& chain, const ColumnMap& map) {
  KINFER_TRY(text, read_text_file(path));
  return parse_reach_targets(text, path.string(), chain, map);
}

std::string format_postures_csv(const std::vector<ReachSolution>& solutions, const std::vector<JointColumn>& columns) {
  std::string text = "target,posture,status,";
  for (const JointColumn& column : columns) text += column.header + ",";
  text += "position_error[mm],angle_error[deg]\n";
  for (std::size_t i = 0; i < solutions.size(); ++i)
    for (std::size_t p = 0; p < solutions[i].postures.size(); ++p) {
      text += fmt::format("{},{},{},", i + 1, p + 1, name(solutions[i].status));
      for (std::size_t k = 0; k < columns.size(); ++k)
        text += format_number(solutions[i].postures[p].q[static_cast<Eigen::Index>(k)], columns[k].factor) + ",";
      // The errors are those of the first posture; the others meet the same tolerance.
      text += format_number(solutions[i].position_error, 1e-3) + "," +
              format_number(solutions[i].angle_error, std::numbers::pi / 180.0) + "\n";
    }
  return text;
}

}  // namespace kinfer
