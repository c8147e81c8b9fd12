// SPDX-License-Identifier: Apache-2.0
// An excerpt of a long recording: the windows most informative about the joints, concatenated to a short recording. The
// global parameters are estimated from it in a fraction of the time; the whole recording then only refines them.
//
// Windows are separated by a few intervals without measurements, in which the splines may jump.
#pragma once

#include "kinfer/estimate/continuous/solver/batch_fit.hpp"

namespace kinfer {

constexpr Eigen::Index excerpt_window = 64;

/// `count` windows of `excerpt_window` intervals, in order of time, chosen greedily to maximise Σ log of each joint's
/// rotational excitation: the squared difference of the two adjacent INS' angular speeds [rad²/s²], which needs no
/// orientations.
std::vector<Eigen::Index> most_informative_windows(const InsProblem& problem, const InsBodies& bodies,
                                                   Eigen::Index count);

/// The measurements of some windows and the initial values of their motion. Facts and clocks are left to the fit of the
/// whole recording.
struct InsExcerpt {
  InsProblem problem;
  InsUnknowns start;
};
InsExcerpt excerpt_of(const InsProblem& problem, const InsUnknowns& start, const std::vector<Eigen::Index>& windows);

/// If the recording is long: fits an excerpt first and puts its global parameters into `start` and the instruments'
/// noise into `problem`. Returns whether it did.
bool start_from_excerpt(InsProblem& problem, InsUnknowns& start, const InsFitOptions& options,
                        const Observer& observer = {});

}  // namespace kinfer
