// What the data can tell, and in words what they cannot.
#pragma once

#include "kinfer/evidence/estimate.hpp"

namespace kinfer {

/// `jacobian`: believed data rows x free parameters, in units of the noise (no prior rows). Singular values of
/// jacobian · diag(prior_sd): above 1 the data know a combination better than the tolerances do. Parameters without a
/// prior are scaled by their `scale`.
Identifiability identifiability(ConstMatrixRef jacobian, const ParameterSet& set);

}  // namespace kinfer
