// SPDX-License-Identifier: Apache-2.0
// Columns qw, qx, qy, qz, or rx, ry, rz of a column map with Euler angles, with srx, sry, srz.
#include <cmath>

#include "kinfer/io/pose_set/measurement_columns.hpp"
#include "kinfer/io/pose_set/pose_covariances.hpp"

namespace kinfer {
namespace {

constexpr double quaternion_slack = 0.01;  // a norm further from 1 is not rounding

void read_quaternions(PoseColumns& columns, PoseSet& set) {
  const auto vector_part = columns.vectors({"qx", "qy", "qz"}, Dimension::one);
  const auto scalar_part = columns.numbers("qw", Dimension::one);
  if (vector_part.has_value() != scalar_part.has_value())
    return columns.report_header_error("an orientation needs the columns qw, qx, qy and qz");
  if (!scalar_part) return;
  for (std::size_t row = 0; row < columns.rows(); ++row) {
    if (vector_part->measured(row) == std::isnan((*scalar_part)[row]))
      columns.report_error(row, "expected qw, qx, qy and qz or none of them");
    if (!vector_part->measured(row)) continue;
    const Vec3 v = vector_part->at(row);
    const Quat orientation((*scalar_part)[row], v.x(), v.y(), v.z());
    if (!(std::abs(orientation.norm() - 1.0) <= quaternion_slack))
      columns.report_error(row, fmt::format("qw, qx, qy, qz: expected a norm of 1, found {:.4g}", orientation.norm()));
    else
      set.orientations.push_back({static_cast<int>(row), orientation.normalized(), {}});
  }
}

void read_euler_angles(PoseColumns& columns, const ColumnMap& map, PoseSet& set) {
  if (!map.euler && !map.is_rotation_vector) {
    if (columns.has("rx"))
      columns.report_header_error("columns rx, ry, rz need a column map that says euler = \"XYZ intrinsic\"");
    return;
  }
  const auto angles = columns.vectors({"rx", "ry", "rz"}, Dimension::angle);
  if (!angles) return columns.report_header_error("the column map says \"euler\", expected columns rx, ry and rz");
  if (columns.has("qw"))
    columns.report_header_error("the orientation is given twice, by qw, qx, qy, qz and by rx, ry, rz");
  for (std::size_t row = 0; row < columns.rows(); ++row)
    if (angles->measured(row))
      set.orientations.push_back(
          {static_cast<int>(row),
           map.euler ? Quat(from_euler(*map.euler, angles->at(row))).normalized() : quat_exp(angles->at(row)),
           {}});
}

void read_orientation_deviations(PoseColumns& columns, PoseSet& set) {
  const auto sd = columns.vectors({"srx", "sry", "srz"}, Dimension::angle);
  if (!sd) return;
  for (OrientationMeasurement& measured : set.orientations) {
    if (!sd->measured(measured.row)) continue;
    measured.sd = sd->at(measured.row);
    if (measured.sd->minCoeff() < 0)
      columns.report_error(measured.row, "srx, sry, srz: expected standard deviations from 0");
  }
}

void read_orientations(PoseColumns& columns, const ReadContext& context, PoseSet& set) {
  read_quaternions(columns, set);
  read_euler_angles(columns, context.map, set);
  read_orientation_deviations(columns, set);
}

void write_orientation_deviations(PoseSheet& sheet, const PoseSet& set) {
  std::optional<std::size_t> deviations;
  for (const OrientationMeasurement& measured : set.orientations) {
    if (measured.axes)
      write_covariance(sheet, "r", measured.row, covariance_of(*measured.sd, measured.axes),
                       CovarianceQuantity::angles);
    if (measured.covariance_with_point) write_cross_covariance(sheet, measured.row, *measured.covariance_with_point);
    if (!measured.sd || measured.axes) continue;
    if (!deviations) deviations = sheet.add_three("sr", sheet.in_angles());
    sheet.set(*deviations, measured.row, *measured.sd, sheet.angle());
  }
}

void write_orientations(PoseSheet& sheet, const PoseSet& set) {
  if (set.orientations.empty()) return;
  const std::size_t scalar = sheet.column("qw"), vector = sheet.add_three("q", "");
  for (const OrientationMeasurement& measured : set.orientations) {
    sheet.set(scalar, measured.row, measured.orientation.w());
    sheet.set(vector, measured.row, measured.orientation.vec(), 1.0);
  }
  write_orientation_deviations(sheet, set);
}

}  // namespace

template <>
MeasurementColumns measurement_columns<OrientationMeasurement>() {
  return {read_orientations, write_orientations};
}

}  // namespace kinfer
