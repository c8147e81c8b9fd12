// SPDX-License-Identifier: Apache-2.0
// Kinematic loops of a machine whose tree has been fitted: pairs of bodies that share a revolute joint besides the
// tree's own, such as the coupler of a four-bar linkage and the bucket that it moves.
#pragma once

#include "kinfer/estimate/continuous/solver/batch_fit.hpp"
#include "kinfer/identify/loops/loop_odds.hpp"

namespace kinfer::identify {

struct FoundLoop {
  std::size_t first = 0, second = 0;  ///< bodies with a sensor; the tree's path between them has at least three joints
  std::vector<std::size_t> joints{};  ///< bodies whose joints are on that path, without rigid ones, from first on
  LoopEvidence evidence{};
  double log_odds = 0.0;
};

/// All pairs that may close a loop, most likely first: the path between them has three revolute joints or more, all of
/// them moving, and no other kind but rigid ones. (With two, the axes may merely coincide or intersect.)
std::vector<FoundLoop> loop_candidates(const InsProblem& problem, const InsFit& fit);

/// Those with the odds for them; of pairs that are rigidly joined to each other's, one.
std::vector<FoundLoop> find_loops(const InsProblem& problem, const InsFit& fit);

}  // namespace kinfer::identify
