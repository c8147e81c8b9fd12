// SPDX-License-Identifier: Apache-2.0
// Surveyed points and tape lengths that the recording and the other facts contradict. A fact is wrong with the odds
//   p(wrong) / p(right) · exp(½ (c − c_i)) · (sd / span)ⁿ,
// c and c_i: −2 log likelihood of the fits with and without it, span: that of the surveyed points, n = 3, or the
// length, n = 1, within which a wrong one lies anywhere.
#pragma once

#include "kinfer/evidence/facts/findings.hpp"
#include "kinfer/identify/refinement/fits/refinement_fits.hpp"

namespace kinfer::identify {

/// Leaves out of `facts` and of the fit what is wrong with clear odds, and says so; where facts contradict each other
/// and none is the odd one, the finding is a fault. `facts`: those of the task.
std::vector<Finding> leave_out_wrong_facts(InsFacts& facts, const RefinementTask& task, RefinementFit& fitted);

}  // namespace kinfer::identify
