// An INS on a mount that gives way (foam, tape, a bracket of sheet metal, skin): its mass stands above the mount, so
// that it tips over in proportion to the specific force, without delay where the motion is slower than its own swaying.
//
// With θ = T (f − f̄), T the tilt [rad per m/s²], f what the INS itself feels and f̄ the mean of it over the recording:
//   rate = exp(−θ) ω + J(θ) θ̇,  force = exp(−θ) f  of what an INS would feel that is fixed to the segment as this one
// lies on average. J: right Jacobian of SO(3). Gravity turns with the segment, so the leaning is in step with the
// motion and does not average out: 5° under its own weight are nearly a tenth of every angle that the gyroscope shows.
#pragma once

#include "kinfer/estimate/ins_blocks.hpp"
#include "kinfer/estimate/ins_chain.hpp"

namespace kinfer {

/// What bends a mount within one interval of the grid, a row a node: f − f̄ [m/s²] and its derivative by time.
struct InsBending {
  using Rows = Eigen::Matrix<float, block_nodes, 3, Eigen::DontAlign>;
  Rows force = Rows::Zero(), change = Rows::Zero();

  Vec3 force_at(std::size_t node) const {
    return force.row(static_cast<Eigen::Index>(node)).transpose().cast<double>();
  }
  Vec3 change_at(std::size_t node) const {
    return change.row(static_cast<Eigen::Index>(node)).transpose().cast<double>();
  }
};

/// One an interval, from readings that are smooth on the grid; gaps are bridged.
std::vector<InsBending> mount_bending(const InsSensor& sensor, std::span<const double> time, const SplineGrid& grid);

/// What the INS feels when its segment moves like `segment`.
InsState felt(const InsState& segment, const Mat3& tilt, const Vec3& force, const Vec3& force_change);

/// The same with derivatives by the numbers of the tilt, column by column, and the turn between both.
struct FeltDerivative {
  InsState state;
  Mat3 turn;  ///< exp(−θ)
  Eigen::Matrix<double, 3, 9> rate_by_tilt, force_by_tilt, field_by_tilt;
};
FeltDerivative felt_derivative(const InsState& segment, const Mat3& tilt, const Vec3& force, const Vec3& force_change);

}  // namespace kinfer
