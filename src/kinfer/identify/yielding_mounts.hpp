// How far the mounts of a recording's sensors give way, as the recording itself shows it.
//
// Not every number of a tilt leaves a trace: a lean about a hinge looks like a smaller angle of that hinge. What the
// visible ones show is what the hidden ones may be (empirical Bayes; the evidence's fixed point, MacKay 1992):
// sd² = Σ t² / Σ (1 − variance / sd²). So a chain of firm mounts keeps its intervals, and a yielding one is told so.
#pragma once

#include "kinfer/estimate/ins_covariance.hpp"
#include "kinfer/estimate/ins_fit.hpp"

namespace kinfer {

/// [rad per m/s²] what a mount of unknown make may tilt: 6 degrees under the sensor's own weight.
inline constexpr double unknown_tilt = 0.01;

/// [rad per m/s²] the standard deviation that the tilts of a fit show. `covariance` at the fit, its tilts free.
double shown_tilt(const InsProblem& problem, const InsFit& fit, const InsCovariance& covariance);

}  // namespace kinfer
