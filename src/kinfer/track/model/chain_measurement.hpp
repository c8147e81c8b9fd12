// SPDX-License-Identifier: Apache-2.0
// What the sensors on a chain should measure in a state, and its derivatives by the error state: angular velocities and
// specific forces carried through the chain's own kinematics,
//
//   z_g = (I + S_g) ω + b_g,  z_a = (I + S_a) f + b_a.
//
// Most derivatives are zero: those by the states of other sensors, and of joints and geometry that do not lead to the
// sensor. Only the others are kept.
#pragma once

#include "kinfer/track/model/chain_state.hpp"

namespace kinfer::track {

/// Six rows per sensor, gyroscope then accelerometer.
struct ChainMeasurement {
  VectorXd value;                             ///< rows
  MatrixXd by_fast;                           ///< rows x fast states
  MatrixXd by_geometry;                       ///< rows x unseen states, then those of the geometry
  std::vector<Vec3> angular_velocity, force;  ///< true ones at each sensor: derivatives by its scale matrices
  std::vector<Index> fast_end, geometry_end;  ///< of each sensor: derivatives beyond these are zero
};

/// Evaluates a chain again and again in buffers of its own.
class ChainEvaluator {
 public:
  explicit ChainEvaluator(const FilterModel& model);

  /// Nothing is allocated.
  void evaluate(const FilterModel& model, const ChainState& state);

  const ChainMeasurement& result() const { return result_; }
  const InsState& body(std::size_t index) const { return states_[index]; }
  /// Derivative of a body's ω, ω̇ and f by its parent's.
  const Eigen::Matrix<double, 9, 9>& by_parent(std::size_t body) const { return derivatives_[body].by_parent; }

 private:
  void propagate_body(const FilterModel& model, const ChainState& state, std::size_t b);
  void measure(const FilterModel& model, const ChainState& state, std::size_t sensor);

  InsBodies bodies_;
  std::vector<InsState> states_;
  std::vector<MatrixXd> by_fast_, by_geometry_;    // of each body: 9 rows (ω, ω̇, f)
  std::vector<PropagatedDerivative> derivatives_;  // of each body, since their sizes differ
  ChainMeasurement result_;
};

/// The values alone, for references and starts.
VectorXd predicted_measurement(const FilterModel& model, const ChainState& state);

}  // namespace kinfer::track
