// SPDX-License-Identifier: Apache-2.0
// Ball in socket: socket position − p. The socket position is an unknown of the fit like any other.

#include "kinfer/estimate/poses/instruments/residual_kind.hpp"

namespace kinfer {
namespace {

constexpr FixtureKind socket_kind = fixture_kind("socket");

void ball_in_socket_residual(const ResidualContext& scene, std::size_t index, BlockRows& out) {
  const SocketContact& contact = scene.data.contacts[index];
  const Target& socket = scene.chain.fixtures.sockets[contact.socket];
  out.residuals.segment<3>(out.row) = socket.xyz - scene.at.pose[contact.row].position;
  if (!out.jacobian) return;
  auto rows = out.jacobian->middleRows<3>(out.row);
  rows = -scene.at.twists[contact.row].topRows<3>();
  for (int k = 0; k < 3; ++k)
    if (const Eigen::Index column = scene.columns.of(socket_kind, contact.socket)[k]; column >= 0)
      rows.col(column) = Vec3::Unit(k);
}

}  // namespace

template <>
ResidualModel residual_model<SocketContact>() {
  return {.write = ball_in_socket_residual};
}

}  // namespace kinfer
