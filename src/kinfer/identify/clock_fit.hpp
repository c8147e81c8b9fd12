// Clock offsets and drifts as unknowns of the continuous-time fit.
#pragma once

#include "kinfer/estimate/ins_covariance.hpp"
#include "kinfer/identify/refine.hpp"

namespace kinfer {

/// Gives every sensor's clock a prior against that of the sensor that turns most.
void free_clocks(InsProblem& problem);

/// Whether one step of the fit with free clocks would move a clock farther than noise and model errors excuse.
bool clocks_are_doubtful(InsProblem& problem, const InsFit& fit, int threads);

/// Carries a fit on with free clocks; problem and fit stay as they were where no clock then differs beyond doubt.
void refit_with_clocks(InsProblem& problem, InsFit& fit, const InsFitOptions& options, const Observer& observer);

/// Of every sensor; empty where clocks were not free.
std::vector<RefinedClock> refined_clocks(const InsProblem& problem, const InsFit& fit, const InsCovariance& covariance);

}  // namespace kinfer
