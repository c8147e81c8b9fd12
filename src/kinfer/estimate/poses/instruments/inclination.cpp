// SPDX-License-Identifier: Apache-2.0
// An accelerometer at rest on the tool measures −g in the tool frame. Only the direction is compared, since its scale
// is rarely known as accurately as an angle. With B two unit vectors orthogonal to the measured direction, the residual
// is Bᵀ Rᵀ g, zero if both agree; d(Rᵀ g) = Rᵀ (g × δ) + Rᵀ dg for a rotation δ of the tool.

#include "kinfer/base/angle.hpp"
#include "kinfer/base/constants.hpp"
#include "kinfer/estimate/poses/instruments/residual_kind.hpp"

namespace kinfer {
namespace {

void inclination_residual(const ResidualContext& scene, std::size_t index, BlockRows& out) {
  const TiltMeasurement& tilt = scene.data.tilts[index];
  const Vec3 direction = tilt.specific_force.normalized();
  Eigen::Matrix<double, 3, 2> across;
  across.col(0) = any_perpendicular(direction);
  across.col(1) = direction.cross(across.col(0));
  const Mat3 tool_R_world = scene.at.pose[tilt.row].rotation.transpose();
  const Vec3& gravity = scene.chain.gravity;
  out.residuals.segment<2>(out.row) = across.transpose() * tool_R_world * gravity;
  if (!out.jacobian) return;
  auto rows = out.jacobian->middleRows<2>(out.row);
  const Eigen::Matrix<double, 2, 3> seen = across.transpose() * tool_R_world;
  rows = seen * skew(gravity) * scene.at.twists[tilt.row].bottomRows<3>();
  for (int k = 0; k < 3; ++k)
    if (const Eigen::Index column = scene.columns.gravity[k]; column >= 0) rows.col(column) = seen.col(k);
}

}  // namespace

template <>
ResidualModel residual_model<TiltMeasurement>() {
  return {.write = inclination_residual};
}

}  // namespace kinfer
