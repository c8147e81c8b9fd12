// SPDX-License-Identifier: Apache-2.0
// What measurements of unstated noise say of model terms: the noise level is marginalised.
//
// With few residuals beside many parameters the fit of all candidates explains nearly everything: the noise level that
// its residuals show is too small by any factor, and terms are supported that do not exist. So the likelihood of the
// terms is that of a mixture over noise levels, half-Cauchy about the one of geometry alone (Gelman 2006): with the
// squares S of n residuals of unstated noise and all parameters but the terms marginalised,
//   log p(data | level, u = 0) = −n log level − ½ S/level² − ½ log |H/level² + P| + …       (P: priors and stated
//   noise)
#pragma once

#include <optional>
#include <vector>

#include "kinfer/calibrate/terms/candidate_terms.hpp"
#include "kinfer/evidence/calibration/estimate.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer::calibrate {

/// About the fit of geometry, at each noise level that is possible. Empty where the noise is stated, or well known from
/// many residuals. With no more residuals than candidates, stated noise counts as the lowest level, where geometry does
/// not explain the measurements: an error that no term has is explained by some of them. `all`: geometry with all
/// candidates at zero, of which `terms` are weighed.
std::vector<TermsAtNoise> linearise_at_noise_levels(const Estimate& geometry, const TermModel& all, const PoseSet& rows,
                                                    const std::optional<Instrument>& instrument);

}  // namespace kinfer::calibrate
