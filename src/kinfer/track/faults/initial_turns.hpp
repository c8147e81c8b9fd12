// SPDX-License-Identifier: Apache-2.0
// A sensor that was turned before the first row. The filter takes the turn for joint positions and sensor errors from
// the first row on, and nothing changes that a watch on changes could see; but the turn is the same in all stretches
// of the log, and no position explains it while the joints beside it move.
//
// Of a turn θ the filter's scores b and information A (ConstantFaults) have the log-likelihood bᵀθ − ½ θᵀAθ. Where the
// chain does not explain the motion, scores scatter by more than A from stretch to stretch, Σ r rᵀ with
// r = b_k − A_k θ̂, and both count less by that factor (cluster-robust). Odds: θ ~ N(0, Σ) of a sensor that somebody
// turned against that of one that sits as it did, as far as the identification's residuals tell.
#pragma once

#include <optional>

#include "kinfer/track/faults/mount_turn.hpp"

namespace kinfer::track {

/// A turn of a sensor's mounting since the first row.
struct InitialTurn {
  std::size_t sensor = 0;
  MountTurn turn{};
  double excess = 1.0;              ///< by which the scores that it follows from count less
  double log_odds = 0.0;            ///< against a sensor that sits as it did, ln
  double log_odds_of_sensor = 0.0;  ///< against the next best constant fault

  /// While joints rest, a turn of the next sensor explains the same.
  bool tells_sensor() const;
};

/// The likeliest constant fault, if that is a turn and likely enough.
std::optional<InitialTurn> initial_turn(const ChainFilter& filter);

}  // namespace kinfer::track
