// SPDX-License-Identifier: Apache-2.0
// Whether an identification may be used, and the figures that this rests on.
#pragma once

#include "kinfer/evidence/identification/identification.hpp"

namespace kinfer::identify {

/// rms acceleration residual of the worst sensor, over the held-out windows if there are any, else over the fitted
/// rows.
PredictionSummary summarise_prediction(const MotionEvidence& motion);

/// do_not_use: a fault was not corrected, or the evidence is against a joint, or no joint is certain (each is weakly
/// connected or never moved); use_with_care: not every joint is as certain and as accurate as wanted.
Usability usability(const std::vector<Finding>& findings, const std::vector<JointEstimate>& joints,
                    const std::vector<JointVerdict>& verdicts);

}  // namespace kinfer::identify
