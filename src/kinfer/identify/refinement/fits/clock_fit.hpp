// SPDX-License-Identifier: Apache-2.0
// Clock offsets and drifts as unknowns of the continuous-time fit.
#pragma once

#include "kinfer/estimate/continuous/solver/batch_fit.hpp"
#include "kinfer/estimate/continuous/solver/covariance.hpp"
#include "kinfer/identify/refinement/fits/residual_clock.hpp"

namespace kinfer::identify {

/// Gives every sensor's clock a finite prior relative to the clock of that of the bodies' sensors which rotates most.
void free_clocks(InsProblem& problem, const InsBodies& bodies);

/// Whether one step of the fit with free clocks moves a clock significantly, given noise and model errors.
bool clocks_are_doubtful(InsProblem& problem, const InsFit& fit, int threads);

/// Continues a fit with free clocks. Problem and fit stay unchanged if no clock then differs significantly.
void refit_with_free_clocks(InsProblem& problem, InsFit& fit, const InsFitOptions& options, const Observer& observer);

/// Whether a clock is wrong by so much, at some time of the recording, that it is corrected before slow motion alone is
/// fitted, where clocks are neglected.
bool clocks_differ(const SplineGrid& grid, const InsUnknowns& x);

/// One per sensor; empty if the clocks were not free.
std::vector<ResidualClock> refined_clocks(const InsProblem& problem, const InsFit& fit,
                                          const InsCovariance& covariance);

}  // namespace kinfer::identify
