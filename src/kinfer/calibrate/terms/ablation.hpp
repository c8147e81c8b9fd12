// SPDX-License-Identifier: Apache-2.0
// A fitted model without some of its terms, or with smaller ones, the others adjusted: no second fit is needed near
// the optimum.
#pragma once

#include <functional>
#include <span>

#include "kinfer/calibrate/terms/candidate_terms.hpp"
#include "kinfer/calibrate/terms/holdout_errors.hpp"

namespace kinfer::calibrate {

/// The chain of a fit, had some free parameters had `scale` [1, at most 1] times the prior standard deviations that
/// they have; at 0 they are at their prior means. With the posterior N(x, C), prior means m and the variances D by
/// which the precisions grow (1/D = (1/scale² − 1) / prior_sd²), all move to x − C_{·r} (C_rr + D)⁻¹ (x_r − m): the fit
/// with these priors, to first order.
Chain chain_with_scaled_priors(const Estimate& fit, std::span<const int> parameters, std::span<const double> scale);

/// The same without these parameters.
Chain chain_without(const Estimate& fit, std::span<const int> removed);

/// Held-out errors of the models whose fits are `fits.split_fits`, had each term `scale` times the priors that it has;
/// without it where that is 0.
HoldoutErrors errors_with_scaled_terms(const HoldoutErrors& fits, const std::vector<CandidateParameter>& terms,
                                       const std::function<double(Term)>& scale, const PoseSet& rows,
                                       const std::vector<Split>& splits, int threads);

/// [m] rms over the poses of what terms of a chain move the tool by, all other numbers as they are.
double displacement(const Chain& chain, const std::vector<CandidateParameter>& terms, const PoseSet& rows);

}  // namespace kinfer::calibrate
