// SPDX-License-Identifier: Apache-2.0
// Columns station with hz, v (theodolite: hz clockwise seen from above, v from the zenith) or with ray_x, ray_y, ray_z
// (calibrated camera; of any length). Written as rays.
#include <cmath>

#include "kinfer/io/pose_set/measurement_columns.hpp"

namespace kinfer {
namespace {

/// hz = 0 is the station's x axis, v = 0 its z axis.
Vec3 direction_of_angles(double hz, double v) {
  return {std::sin(v) * std::cos(hz), -std::sin(v) * std::sin(hz), std::cos(v)};
}

/// One direction per row, zero where there is none.
std::vector<Vec3> read_direction_vectors(PoseColumns& columns) {
  std::vector<Vec3> directions(columns.rows(), Vec3::Zero());
  const auto rays = columns.vectors({"ray_x", "ray_y", "ray_z"}, Dimension::one);
  const auto hz = columns.numbers("hz", Dimension::angle), v = columns.numbers("v", Dimension::angle);
  if (hz.has_value() != v.has_value()) columns.report_header_error("a direction needs the columns hz and v");
  for (std::size_t row = 0; row < columns.rows(); ++row) {
    const bool has_ray = rays && rays->measured(row), has_hz = hz && !std::isnan((*hz)[row]),
               has_v = v && !std::isnan((*v)[row]);
    if (hz && v && has_hz != has_v) columns.report_error(row, "expected hz and v or none of them");
    if (has_ray && has_hz)
      columns.report_error(row, "the direction is given twice, by hz, v and by ray_x, ray_y, ray_z");
    if (has_hz && has_v) directions[row] = direction_of_angles((*hz)[row], (*v)[row]);
    if (!has_ray) continue;
    directions[row] = rays->at(row).normalized();
    if (!(rays->at(row).norm() > 0.0))
      columns.report_error(row, "ray_x, ray_y, ray_z: expected a direction, found zero");
  }
  return directions;
}

void read_directions(PoseColumns& columns, const ReadContext& context, PoseSet& set) {
  const std::vector<Vec3> directions = read_direction_vectors(columns);
  auto stations = columns.name_indices("station");
  for (std::size_t row = 0; row < columns.rows(); ++row) {
    const int station = stations ? stations->index[row] : -1;
    const bool measured = directions[row].norm() > 0.0;
    if (measured && station >= 0) set.directions.push_back({static_cast<int>(row), station, directions[row]});
    if (measured && station < 0) columns.report_error(row, "column station: the name of the station is missing");
    if (!measured && station >= 0 && context.required == RequiredContent::measurements)
      columns.report_error(row, "columns hz, v or ray_x, ray_y, ray_z: the direction from the station is missing");
  }
  if (stations) set.stations = std::move(stations->names);
}

void write_directions(PoseSheet& sheet, const PoseSet& set) {
  write_fixture_names<DirectionMeasurement>(sheet, set);
  if (set.directions.empty()) return;
  const std::size_t ray = sheet.add_three("ray_", "");
  for (const DirectionMeasurement& measured : set.directions) sheet.set(ray, measured.row, measured.direction, 1.0);
}

}  // namespace

template <>
MeasurementColumns measurement_columns<DirectionMeasurement>() {
  return {read_directions, write_directions};
}

}  // namespace kinfer
