// SPDX-License-Identifier: Apache-2.0
// Columns tilt_x, tilt_y, tilt_z: specific force on the tool at rest.
#include "kinfer/io/pose_set/measurement_columns.hpp"

namespace kinfer {
namespace {

void read_tilts(PoseColumns& columns, const ReadContext&, PoseSet& set) {
  const auto tilts = columns.vectors({"tilt_x", "tilt_y", "tilt_z"}, Dimension::acceleration);
  if (!tilts) return;
  for (std::size_t row = 0; row < columns.rows(); ++row)
    if (tilts->measured(row)) set.tilts.push_back({static_cast<int>(row), tilts->at(row)});
}

void write_tilts(PoseSheet& sheet, const PoseSet& set) {
  if (set.tilts.empty()) return;
  const std::size_t tilt = sheet.add_three("tilt_", "");
  for (const TiltMeasurement& measured : set.tilts) sheet.set(tilt, measured.row, measured.specific_force, 1.0);
}

}  // namespace

template <>
MeasurementColumns measurement_columns<TiltMeasurement>() {
  return {read_tilts, write_tilts};
}

}  // namespace kinfer
