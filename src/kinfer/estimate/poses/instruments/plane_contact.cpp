// SPDX-License-Identifier: Apache-2.0
// Tool point on an unknown plane: offset − n · p. The normal is parametrised by two small angles, so it stays a unit
// vector: n = R (sin b, −sin a cos b, cos a cos b).

#include <cmath>

#include "kinfer/estimate/poses/instruments/residual_kind.hpp"

namespace kinfer {
namespace {

void write(const ResidualContext& scene, std::size_t index, BlockRows& out) {
  const PlaneContact& contact = scene.data.plane_contacts[index];
  const Plane& plane = scene.chain.fixtures.planes[contact.plane];
  const Vec3 normal = plane.normal(), point = scene.at.pose[contact.row].position;
  out.residuals[out.row] = plane.offset - normal.dot(point);
  if (!out.jacobian) return;
  auto row = out.jacobian->row(out.row);
  row = -normal.transpose() * scene.at.twists[contact.row].topRows<3>();
  const auto [rx, ry, offset] = scene.columns.plane[contact.plane];
  const double sa = std::sin(plane.small_rotation.x()), ca = std::cos(plane.small_rotation.x());
  const double sb = std::sin(plane.small_rotation.y()), cb = std::cos(plane.small_rotation.y());
  if (rx >= 0) row[rx] = -point.dot(plane.rotation * Vec3(0.0, -ca * cb, -sa * cb));
  if (ry >= 0) row[ry] = -point.dot(plane.rotation * Vec3(cb, sa * sb, -ca * sb));
  if (offset >= 0) row[offset] = 1.0;
}

Vec3 specified_sd(const PoseSet&, std::size_t, const Instrument& instrument) {
  return Vec3::Constant(instrument.sigma_contact.value_or(instrument.sigma));
}

}  // namespace

ResidualKind plane_residual() {
  return {.kind = MeasurementKind::plane,
          .size = 1,
          .count = [](const PoseSet& data) { return data.plane_contacts.size(); },
          .row = [](const PoseSet& data, std::size_t i) { return data.plane_contacts[i].row; },
          .keep = [](PoseSet& data, const std::vector<bool>& kept) { keep_entries(data.plane_contacts, kept); },
          .specified_sd = specified_sd,
          .write = write};
}

}  // namespace kinfer
