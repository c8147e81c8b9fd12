// SPDX-License-Identifier: Apache-2.0
// What is known of a machine's motion beside its sensors: a moving base stays about where it is, a prismatic joint in
// its range, a joint that has been steady may rest, and the axes of a loose revolute joint are about aligned.
//
// N(0, σ²) with a correlation time τ is worth white noise of variance σ² 2τ / length in each block.
#pragma once

#include "kinfer/track/filter/base_speed.hpp"
#include "kinfer/track/filter/update_system.hpp"
#include "kinfer/track/model/chain_state.hpp"

namespace kinfer::track {

class SoftRows {
 public:
  explicit SoftRows(const FilterModel& model);

  /// Adds rows to those of the sensors. `p`: covariance of the states; `length` [s] of the block.
  void add(const FilterModel& model, const ChainState& state, const MatrixXd& p, double length, UpdateSystem& system);

 private:
  struct SteadyVelocity {
    double velocity = 0.0, duration = 0.0;  // [m/s] or [rad/s], [s] since it has been about that
  };
  struct RestOdds {
    double speed, creep, steadiness;  // [m/s] or [rad/s] of a joint that moves; of one that rests; of a steady one
  };

  static bool rests(SteadyVelocity& steady, double velocity, double variance, const RestOdds& odds, double length);
  bool shows_acceleration(const FilterModel& model, BaseMode base, const UpdateSystem& system, Index position);

  BaseSpeed base_speed_;
  std::vector<SteadyVelocity> prismatic_, revolute_;  // of these joints of the model
  MatrixXd accelerations_;                            // information about those of joints and base
  VectorXd solution_;
};

}  // namespace kinfer::track
