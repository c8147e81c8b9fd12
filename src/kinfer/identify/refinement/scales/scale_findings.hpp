// SPDX-License-Identifier: Apache-2.0
// What instruments that read too much or too little mean for those who use the chain.
#pragma once

#include "kinfer/estimate/continuous/solver/covariance.hpp"
#include "kinfer/evidence/facts/findings.hpp"
#include "kinfer/identify/handover/parameter_covariance.hpp"
#include "kinfer/identify/refinement/scales/instrument_scales.hpp"

namespace kinfer::identify {

/// What is said about them, by the estimates of a fit under such priors.
std::vector<Finding> scale_findings(const ScaleReview& review, const RecordedMotion& motion, const InsFit& fit,
                                    const InsCovariance& covariance);

/// A clock that counts c seconds in one gives the same measurements as gyroscopes that read c times too much on a
/// machine of c times c its lengths: adds the lengths as an alternative model, where all gyroscopes share a factor.
void add_clock_rate(const ScaleReview& review, const InsFit& fit, const InsCovariance& covariance, ModelError& error);

}  // namespace kinfer::identify
