// SPDX-License-Identifier: Apache-2.0
// Draw wire: measured distance − |p − base · anchor|. The anchors are fixed in the base frame, so the base frame has no
// effect; their positions are unknowns with the tolerance as prior.

#include "kinfer/estimate/poses/instruments/residual_kind.hpp"

namespace kinfer {
namespace {

constexpr FixtureKind anchor_kind = fixture_kind("anchor");

Pose base_of(const ResidualContext& scene, int row) {
  const int mounting = scene.mounting(row);
  const bool own = mounting >= 0 && scene.chain.mountings[mounting].base;
  return own ? scene.chain.mountings[mounting].base->pose() : scene.chain.base.pose();
}

void draw_wire_residual(const ResidualContext& scene, std::size_t index, BlockRows& out) {
  const DistanceMeasurement& measured = scene.data.distances[index];
  const Pose base = base_of(scene, measured.row);
  const Vec3 wire = scene.at.pose[measured.row].position - base * scene.chain.fixtures.anchors[measured.anchor];
  const double length = wire.norm();
  out.residuals[out.row] = measured.distance - length;
  if (!out.jacobian) return;
  const Vec3 along = length > 0.0 ? Vec3(wire / length) : Vec3::UnitX().eval();  // at the anchor any direction is valid
  auto row = out.jacobian->row(out.row);
  row = -along.transpose() * scene.at.twists[measured.row].topRows<3>();
  for (const Eigen::Index column : scene.columns.base) row[column] = 0.0;
  for (int k = 0; k < 3; ++k)
    if (const Eigen::Index column = scene.columns.of(anchor_kind, measured.anchor)[k]; column >= 0)
      row[column] = along.dot(base.rotation.col(k));
}

Vec3 draw_wire_sd(const PoseSet& data, std::size_t index, const Instrument& instrument) {
  return Vec3::Constant(DistanceMeasurement::traits.sigma_of(instrument) +
                        1e-6 * instrument.ppm * data.distances[index].distance);
}

}  // namespace

template <>
ResidualModel residual_model<DistanceMeasurement>() {
  return {.write = draw_wire_residual, .specified_sd = draw_wire_sd};
}

}  // namespace kinfer
