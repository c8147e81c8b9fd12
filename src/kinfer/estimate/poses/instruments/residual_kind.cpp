// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/poses/instruments/residual_kind.hpp"

#include "kinfer/base/expect.hpp"

namespace kinfer {

std::span<const ResidualKind> residual_kinds() {
  static const std::array<ResidualKind, measurement_kinds> kinds{
      point_residual(), orientation_residual(), contact_residual(), distance_residual(),
      pair_residual(),  plane_residual(),       tilt_residual()};
  return kinds;
}

const ResidualKind& residual_kind(MeasurementKind kind) {
  const ResidualKind& found = residual_kinds()[static_cast<std::size_t>(kind)];
  KINFER_EXPECT(found.kind == kind, "the kinds are listed in their own order");
  return found;
}

FixtureColumns fixture_columns(const Chain& chain, const ParameterSet& set) {
  constexpr FixtureColumns::Xyz none{-1, -1, -1};
  FixtureColumns columns;
  columns.target.assign(chain.targets.size(), none);
  columns.anchor.assign(chain.fixtures.anchors.size(), none);
  columns.socket.assign(chain.fixtures.sockets.size(), none);
  columns.plane.assign(chain.fixtures.planes.size(), none);
  Eigen::Index column = 0;
  for (const Parameter* parameter : set.free()) {
    const ParameterAddress& at = parameter->at;
    const int axis = static_cast<int>(at.field) - static_cast<int>(Field::x);
    if (at.owner == Owner::target) columns.target[at.joint][axis] = column;
    if (at.owner == Owner::anchor) columns.anchor[at.joint][axis] = column;
    if (at.owner == Owner::socket) columns.socket[at.joint][axis] = column;
    if (at.owner == Owner::gravity) columns.gravity[axis] = column;
    if (at.owner == Owner::plane)
      columns.plane[at.joint][at.field == Field::rx ? 0 : at.field == Field::ry ? 1 : 2] = column;
    if (at.owner == Owner::base || at.owner == Owner::mounting_base) columns.base.push_back(column);
    ++column;
  }
  return columns;
}

}  // namespace kinfer
