// SPDX-License-Identifier: Apache-2.0
// What instruments that read too much or too little mean for those who use the chain.
#pragma once

#include "kinfer/estimate/continuous/solver/covariance.hpp"
#include "kinfer/evidence/facts/findings.hpp"
#include "kinfer/identify/handover/parameter_covariance.hpp"
#include "kinfer/identify/refinement/scales/instrument_scales.hpp"

namespace kinfer::identify {

/// A clock that runs fast or slow by `scale`, or gyroscopes that all read so much too much. A fault where no fit holds
/// the lengths of both.
Finding clock_rate_finding(double scale, double sd, Severity severity);

/// What is said about them, by the estimates of a fit under such priors; `divided`: by which the recording was.
std::vector<Finding> scale_findings(const ScaleReview& review, const RecordedMotion& motion,
                                    const InsCommonScales& divided, const InsFit& fit, const InsCovariance& covariance);

/// A clock that counts c seconds in one gives the same measurements as gyroscopes that read c times too much on a
/// machine of c times c its lengths: adds the lengths as an alternative model, where all gyroscopes share a factor.
void add_clock_rate(const ScaleReview& review, const InsCommonScales& divided, const InsFit& fit,
                    const InsCovariance& covariance, ModelError& error);

}  // namespace kinfer::identify
