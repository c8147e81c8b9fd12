// SPDX-License-Identifier: Apache-2.0
// Ball in socket: socket position − p. The socket position is an unknown of the fit like any other.

#include "kinfer/estimate/poses/instruments/residual_kind.hpp"

namespace kinfer {
namespace {

void write(const ResidualContext& scene, std::size_t index, BlockRows& out) {
  const SocketContact& contact = scene.data.contacts[index];
  const Target& socket = scene.chain.fixtures.sockets[contact.socket];
  out.residuals.segment<3>(out.row) = socket.xyz - scene.at.pose[contact.row].position;
  if (!out.jacobian) return;
  auto rows = out.jacobian->middleRows<3>(out.row);
  rows = -scene.at.twists[contact.row].topRows<3>();
  for (int k = 0; k < 3; ++k)
    if (const Eigen::Index column = scene.columns.socket[contact.socket][k]; column >= 0)
      rows.col(column) = Vec3::Unit(k);
}

Vec3 specified_sd(const PoseSet&, std::size_t, const Instrument& instrument) {
  return Vec3::Constant(instrument.sigma_contact.value_or(instrument.sigma));
}

}  // namespace

ResidualKind contact_residual() {
  return {.kind = MeasurementKind::contact,
          .size = 3,
          .count = [](const PoseSet& data) { return data.contacts.size(); },
          .row = [](const PoseSet& data, std::size_t i) { return data.contacts[i].row; },
          .keep = [](PoseSet& data, const std::vector<bool>& kept) { keep_entries(data.contacts, kept); },
          .specified_sd = specified_sd,
          .write = write};
}

}  // namespace kinfer
