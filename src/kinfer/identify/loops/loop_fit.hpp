// SPDX-License-Identifier: Apache-2.0
// The fit of a machine with its loops closed: each closing joint is found with the rest, and holds at all times.
#pragma once

#include "kinfer/identify/loops/loop_search.hpp"

namespace kinfer::identify {

/// The closure of a loop for the fit, held at knots of the grid.
InsClosure closure_of(const FoundLoop& loop, const SplineGrid& grid);

/// Closes the loops of a fit: adds them to the problem's facts and fits again from its result. A loop is dropped where
/// the measurements contradict it: where the loss of likelihood exceeds the odds for it. Returns those that are kept.
std::vector<FoundLoop> close_loops(InsProblem& problem, InsFit& fit, const InsFitOptions& options);

}  // namespace kinfer::identify
