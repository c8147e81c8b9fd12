// SPDX-License-Identifier: Apache-2.0
// Tool point on an unknown plane: offset − n · p. The normal is parametrised by two small angles, so it stays a unit
// vector: n = R (sin b, −sin a cos b, cos a cos b).

#include <cmath>

#include "kinfer/estimate/poses/instruments/residual_kind.hpp"

namespace kinfer {
namespace {

constexpr FixtureKind plane_kind = fixture_kind("plane");

void plane_contact_residual(const ResidualContext& scene, std::size_t index, BlockRows& out) {
  const PlaneContact& contact = scene.data.plane_contacts[index];
  const Plane& plane = scene.chain.fixtures.planes[contact.plane];
  const Vec3 normal = plane.normal(), point = scene.at.pose[contact.row].position;
  out.residuals[out.row] = plane.offset - normal.dot(point);
  if (!out.jacobian) return;
  auto row = out.jacobian->row(out.row);
  row = -normal.transpose() * scene.at.twists[contact.row].topRows<3>();
  const FixtureColumns::Numbers& columns = scene.columns.of(plane_kind, contact.plane);
  const Eigen::Index rx = columns[0], ry = columns[1], offset = columns[2];
  const double sa = std::sin(plane.small_rotation.x()), ca = std::cos(plane.small_rotation.x());
  const double sb = std::sin(plane.small_rotation.y()), cb = std::cos(plane.small_rotation.y());
  if (rx >= 0) row[rx] = -point.dot(plane.rotation * Vec3(0.0, -ca * cb, -sa * cb));
  if (ry >= 0) row[ry] = -point.dot(plane.rotation * Vec3(cb, sa * sb, -ca * sb));
  if (offset >= 0) row[offset] = 1.0;
}

}  // namespace

template <>
ResidualModel residual_model<PlaneContact>() {
  return {.write = plane_contact_residual};
}

}  // namespace kinfer
