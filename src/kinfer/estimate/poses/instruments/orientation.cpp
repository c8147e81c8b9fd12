// SPDX-License-Identifier: Apache-2.0
// Measured orientation: log(R_measured R_predictedᵀ), a rotation vector in the world frame.
// R_measured (exp(δ) R)ᵀ = exp(error) exp(−δ), so d error = −J_r⁻¹(error) δ.

#include "kinfer/base/angle.hpp"
#include "kinfer/estimate/poses/instruments/residual_kind.hpp"

namespace kinfer {
namespace {

void orientation_residual(const ResidualContext& scene, std::size_t index, BlockRows& out) {
  const OrientationMeasurement& measured = scene.data.orientations[index];
  const Mat3 misfit = measured.orientation.toRotationMatrix() * scene.at.pose[measured.row].rotation.transpose();
  const Vec3 error = log_so3(misfit);
  out.residuals.segment<3>(out.row) = along_axes(measured.axes, error);
  if (!out.jacobian) return;
  Mat3 slope = -right_jacobian_inverse(error);
  if (measured.axes) slope = measured.axes->transpose() * slope;
  out.jacobian->middleRows<3>(out.row) = slope * scene.at.twists[measured.row].bottomRows<3>();
}

Vec3 orientation_sd(const PoseSet& data, std::size_t index, const Instrument& instrument) {
  const auto& sd = data.orientations[index].sd;
  return sd ? *sd : Vec3::Constant(instrument.sigma_angle);
}

}  // namespace

template <>
ResidualModel residual_model<OrientationMeasurement>() {
  return {.write = orientation_residual, .specified_sd = orientation_sd};
}

}  // namespace kinfer
