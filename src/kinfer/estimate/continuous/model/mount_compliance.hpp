// SPDX-License-Identifier: Apache-2.0
// An INS on a compliant mount (foam, tape, a sheet-metal bracket, skin): its centre of mass is above the mount, so it
// tilts in proportion to the specific force, quasi-statically where the motion is slower than the mount's resonance.
//
// With θ = T (f − f̄), T the tilt compliance [rad per m/s²], f the specific force at the INS and f̄ its mean over the
// recording, the INS measures
//   angular velocity exp(−θ) ω + J(θ) θ̇,  specific force exp(−θ) f,
// with ω and f those of an INS fixed rigidly to the segment at the mean orientation of this one, and J the right
// Jacobian of SO(3). Gravity rotates in the segment's frame, so the tilt is in phase with the motion and does not
// average out: 5° under its own weight change every angle that the gyroscope shows by nearly a tenth.
#pragma once

#include "kinfer/estimate/continuous/model/chain_propagation.hpp"
#include "kinfer/estimate/continuous/model/measurement_blocks.hpp"

namespace kinfer {

/// Load on a mount within one interval of the grid, a row per node: f − f̄ [m/s²] and its time derivative.
struct InsMountLoad {
  using Rows = Eigen::Matrix<float, block_nodes, 3, Eigen::DontAlign>;
  Rows force = Rows::Zero(), change = Rows::Zero();

  Vec3 force_at(std::size_t node) const {
    return force.row(static_cast<Eigen::Index>(node)).transpose().cast<double>();
  }
  Vec3 change_at(std::size_t node) const {
    return change.row(static_cast<Eigen::Index>(node)).transpose().cast<double>();
  }
};

/// One per interval, from a spline fitted to the measured specific force; gaps are bridged.
std::vector<InsMountLoad> mount_loads(const InsSensor& sensor, std::span<const double> time, const SplineGrid& grid);

/// State of the INS on its compliant mount when its segment has the state `segment`.
InsState state_on_mount(const InsState& segment, const Mat3& tilt, const Vec3& force, const Vec3& force_change);

/// The same with derivatives with respect to the tilt compliance (column-major), and the rotation between both.
struct MountDerivative {
  InsState state;
  Mat3 turn;  ///< exp(−θ)
  Eigen::Matrix<double, 3, 9> velocity_by_tilt, force_by_tilt;
};
MountDerivative state_on_mount_derivative(const InsState& segment, const Mat3& tilt, const Vec3& force,
                                          const Vec3& force_change);

}  // namespace kinfer
