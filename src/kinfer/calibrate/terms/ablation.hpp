// SPDX-License-Identifier: Apache-2.0
// A fitted model without some of its terms, the others adjusted: no second fit is needed near the optimum.
#pragma once

#include <functional>
#include <span>

#include "kinfer/calibrate/terms/candidate_terms.hpp"
#include "kinfer/calibrate/terms/holdout_errors.hpp"

namespace kinfer::calibrate {

/// The chain of a fit whose free parameters at `removed` are held at their prior means. With the posterior N(x, C), the
/// others move to x − C_{·r} C_rr⁻¹ (x_r − mean_r), series of the chain by their response to that: the fit without
/// them, to first order.
Chain chain_without(const Estimate& fit, std::span<const int> removed);

/// Held-out errors of the models whose fits are `fits.split_fits`, without the parameters that `remove` accepts.
HoldoutErrors errors_without(const HoldoutErrors& fits, const std::vector<CandidateParameter>& terms,
                             const std::function<bool(Term)>& remove, const PoseSet& rows,
                             const std::vector<Split>& splits, int threads);

/// [m] rms distance between the tools of two chains over the poses.
double rms_distance(const Chain& a, const Chain& b, const PoseSet& rows);

/// [m] rms over the poses of what terms of a chain move the tool by, all other numbers as they are.
double displacement(const Chain& chain, const std::vector<CandidateParameter>& terms, const PoseSet& rows);

}  // namespace kinfer::calibrate
