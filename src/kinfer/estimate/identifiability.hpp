// SPDX-License-Identifier: Apache-2.0
// Identifiability of the parameters from the data: rank, singular values, and the unobservable or confounded
// parameters.
#pragma once

#include "kinfer/evidence/calibration/estimate.hpp"

namespace kinfer {

/// `jacobian`: inlier measurement rows x free parameters, in units of the noise (no prior rows). Singular values are
/// those of jacobian · diag(prior_sd): above 1, the data determine that combination better than the prior does.
/// Parameters without a prior are scaled by their `scale`.
Identifiability identifiability(ConstMatrixRef jacobian, const ParameterSet& set);

}  // namespace kinfer
