// SPDX-License-Identifier: Apache-2.0
// What positions of revolute joints miss that follow from mean rates by the trapezoidal rule (driven_between_rates).
// With blocks of length T and n rows each, the mean of a rate r is r + (1 − 1/n²) T²/24 r̈, and the rule over r leaves
// T²/12 ṙ (Euler and Maclaurin): the position is too large by c T² ṙ, c = 1/12 + (1 − 1/n²)/24. That does not add up,
// but is 0.1° where a joint accelerates by 35 rad/s² in blocks of 20 ms, tenfold what noise leaves.
#pragma once

#include "kinfer/track/model/chain_state.hpp"

namespace kinfer::track {

class MeanRates {
 public:
  explicit MeanRates(const FilterModel& model);

  /// After a start or a gap.
  void reset() { has_accelerations_ = has_rates_ = false; }

  /// After an update, `dt` [s] after the last one, with blocks of `rows` rows: adds the change of what is missed to an
  /// error of the state. Not where rates do not show the motion.
  void add_missed(const FilterModel& model, const ChainState& state, double dt, int rows, VectorXd& error);

 private:
  bool has_rates_ = false, has_accelerations_ = false;
  VectorXd rates_, accelerations_;  // of each joint position, at the last update
};

}  // namespace kinfer::track
