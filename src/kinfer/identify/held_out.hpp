// How well a chain predicts what it was not fitted to: the continuous-time fit again without some windows of the
// recording, from where the fit of all of it ended.
#pragma once

#include "kinfer/estimate/ins_fit.hpp"
#include "kinfer/evidence/identification.hpp"

namespace kinfer {

struct HeldOut {
  std::vector<TimeWindow> windows;  ///< not fitted
  std::vector<FoundJoint> joints;   ///< as the rest of the recording shows them
};

/// A fifth of the grid's intervals in five windows, evenly spread: [begin, end) of each.
std::vector<std::pair<Eigen::Index, Eigen::Index>> held_out_intervals(const SplineGrid& grid);

/// The fit without the readings of these intervals; a few steps from where the fit of all readings ended. `problem` is
/// the same afterwards.
InsFit fit_without(InsProblem& problem, const InsUnknowns& found,
                   const std::vector<std::pair<Eigen::Index, Eigen::Index>>& intervals, const InsFitOptions& options);

}  // namespace kinfer
