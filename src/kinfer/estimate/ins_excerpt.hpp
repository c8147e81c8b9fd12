// An excerpt of a long recording: the windows that tell most about the joints, one behind the other as a recording of
// their own. What holds for good is found from it in a fraction of the time, and the whole recording has only the last
// word.
//
// Between two windows of an excerpt lie a few intervals without readings, in which the splines may jump.
#pragma once

#include "kinfer/estimate/ins_fit.hpp"

namespace kinfer {

constexpr Eigen::Index excerpt_window = 64;

/// So many windows of `excerpt_window` intervals, in order of time: greedily those that add most to Σ log of each
/// joint's turning. A joint's turning shows without orientations in the difference of its two INS' rates [rad²/s²].
std::vector<Eigen::Index> telling_windows(const InsProblem& problem, const InsBodies& bodies, Eigen::Index count);

/// The readings of some windows and where their motion starts. Facts and clocks are left to the whole recording.
struct InsExcerpt {
  InsProblem problem;
  InsUnknowns start;
};
InsExcerpt excerpt_of(const InsProblem& problem, const InsUnknowns& start, const std::vector<Eigen::Index>& windows);

/// Where a recording is long: fits an excerpt first and puts what holds for good into `start`, the instruments' noise
/// into `problem`. True where it did.
bool start_from_excerpt(InsProblem& problem, InsUnknowns& start, const InsFitOptions& options,
                        const Observer& observer = {});

}  // namespace kinfer
