// SPDX-License-Identifier: Apache-2.0
// Held-out validation: the continuous-time fit is repeated without some windows of the recording, started from the fit
// of the whole recording.
#pragma once

#include "kinfer/estimate/continuous/solver/batch_fit.hpp"
#include "kinfer/evidence/identification/identification.hpp"

namespace kinfer::identify {

struct HeldOut {
  std::vector<TimeWindow> windows;    ///< not fitted
  std::vector<JointEstimate> joints;  ///< estimated without these windows
};

/// A fifth of the grid's intervals, in five evenly spaced windows: [begin, end) of each.
std::vector<std::pair<Eigen::Index, Eigen::Index>> held_out_intervals(const SplineGrid& grid);

/// The fit without the measurements of these intervals; a few steps from the fit `found` of all measurements. `problem`
/// is unchanged afterwards.
InsFit fit_without_intervals(InsProblem& problem, const InsUnknowns& found,
                             const std::vector<std::pair<Eigen::Index, Eigen::Index>>& intervals,
                             const InsFitOptions& options);

}  // namespace kinfer::identify
