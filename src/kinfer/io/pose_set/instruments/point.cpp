// SPDX-License-Identifier: Apache-2.0
// Columns x, y, z of the tool point and NAME_x, NAME_y, NAME_z of further targets, with sx, sy, sz.
#include <algorithm>

#include "kinfer/io/pose_set/measurement_columns.hpp"
#include "kinfer/io/pose_set/pose_covariances.hpp"

namespace kinfer {
namespace {

void read_point_deviations(PoseColumns& columns, PoseSet& set) {
  const auto sd = columns.vectors({"sx", "sy", "sz"}, Dimension::length);
  if (!sd) return;
  for (PointMeasurement& point : set.points) {
    if (point.target >= 0 || !sd->measured(point.row)) continue;
    point.sd = sd->at(point.row);
    if (point.sd->minCoeff() < 0) columns.report_error(point.row, "sx, sy, sz: expected standard deviations from 0");
  }
}

void read_points_of(PoseColumns& columns, const std::array<std::string, 3>& names, int target, PoseSet& set) {
  const auto positions = columns.vectors(names, Dimension::length);
  if (!positions) return;
  for (std::size_t row = 0; row < columns.rows(); ++row)
    if (positions->measured(row))
      set.points.push_back({static_cast<int>(row), target, positions->at(row), std::nullopt});
}

void read_targets(PoseColumns& columns, const Chain& chain, PoseSet& set) {
  for (std::size_t i = 0; i < chain.targets.size(); ++i) {
    const std::string& name = chain.targets[i].name;
    read_points_of(columns, {name + "_x", name + "_y", name + "_z"}, static_cast<int>(i), set);
    set.targets.push_back(name);
  }
  const bool any =
      std::any_of(set.points.begin(), set.points.end(), [](const auto& point) { return point.target >= 0; });
  if (!any) set.targets.clear();
}

void read_points(PoseColumns& columns, const ReadContext& context, PoseSet& set) {
  read_points_of(columns, {"x", "y", "z"}, -1, set);
  read_targets(columns, context.chain, set);
  read_point_deviations(columns, set);
}

void write_points_of(PoseSheet& sheet, const PoseSet& set, int target, const std::string& prefix) {
  std::optional<std::size_t> positions, deviations;
  for (const PointMeasurement& point : set.points) {
    if (point.target != target) continue;
    if (!positions) positions = sheet.add_three(prefix, sheet.in_lengths());
    sheet.set(*positions, point.row, point.position, sheet.length());
    if (point.axes)
      write_covariance(sheet, target < 0 ? "p" : set.targets[target], point.row, covariance_of(*point.sd, point.axes),
                       CovarianceQuantity::lengths);
    if (!point.sd || point.axes || target >= 0) continue;
    if (!deviations) deviations = sheet.add_three("s", sheet.in_lengths());
    sheet.set(*deviations, point.row, *point.sd, sheet.length());
  }
}

void write_points(PoseSheet& sheet, const PoseSet& set) {
  write_points_of(sheet, set, -1, "");
  for (std::size_t i = 0; i < set.targets.size(); ++i)
    write_points_of(sheet, set, static_cast<int>(i), set.targets[i] + "_");
}

}  // namespace

template <>
MeasurementColumns measurement_columns<PointMeasurement>() {
  return {read_points, write_points};
}

}  // namespace kinfer
