// SPDX-License-Identifier: Apache-2.0
// Evidence of the order of the segments: pairs, margin, phases, kinematic loops.
#pragma once

#include "kinfer/evidence/identification/identification.hpp"
#include "kinfer/identify/structure/ordered_motion.hpp"

namespace kinfer::identify {

struct OrderReport {
  OrderEvidence evidence;
  std::vector<IdentificationNote> notes;  ///< an unsafe order; phases that imply another one
  std::vector<Finding> findings;          ///< kinematic loops, given links
};

/// The pairs outside the tree that share a joint, too, because they close a loop.
std::vector<PairFit> closing_pairs(const OrderedMotion& ordered, const std::vector<LoopEstimate>& loops);

/// The pairs that close `loops` do not count in the margin.
OrderReport report_order(const OrderedMotion& ordered, const std::vector<LoopEstimate>& loops);

}  // namespace kinfer::identify
