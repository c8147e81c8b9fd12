// SPDX-License-Identifier: Apache-2.0
// Prior of the sensors' mount compliance, estimated from the recording itself.
//
// Not every component of a tilt is observable: a tilt about a revolute axis looks like a smaller joint angle. The
// observable components give the prior standard deviation of the unobservable ones (empirical Bayes; fixed point of the
// evidence, MacKay 1992): sd² = Σ t² / Σ (1 − variance / sd²). So the intervals of a chain with stiff mounts stay
// narrow, and those of a chain with compliant mounts widen.
#pragma once

#include "kinfer/estimate/continuous/solver/batch_fit.hpp"
#include "kinfer/estimate/continuous/solver/covariance.hpp"

namespace kinfer::identify {

/// [rad per m/s²] prior compliance of an unknown mount: a tilt of 6 degrees under the sensor's own weight.
inline constexpr double unknown_mount_compliance = 0.01;

/// [rad per m/s²] standard deviation of the compliances of a fit. `covariance`: at the fit, with free compliances.
double estimate_mount_compliance(const InsProblem& problem, const InsFit& fit, const InsCovariance& covariance);

}  // namespace kinfer::identify
