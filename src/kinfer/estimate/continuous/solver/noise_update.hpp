// SPDX-License-Identifier: Apache-2.0
// Noise of the instruments as estimated from the residuals of a fit: standard deviation and correlation.
#pragma once

#include "kinfer/estimate/continuous/solver/cost.hpp"

namespace kinfer {

/// Integrated autocorrelation time [intervals]: variance of a mean over a long time relative to white noise, 1 + 2 Σ ρ
/// over the lags of the offsets' autocorrelation up to the first that is not positive, at most a tenth of the
/// recording. Mean over the axes; at least 1.
double autocorrelation_time(const InstrumentFit& fit);

/// Sets every instrument's standard deviation from its residuals without outliers, and for magnetometers, whose
/// disturbances are slow, from their correlation too; never below the instrument's own noise. True if one of them
/// changed notably.
bool update_noise(InsProblem& problem, const InsCost& cost);

/// Standard deviations of white noise that has as much power at low frequencies as the residuals: what they are worth
/// as independent samples (long-run variance; Newey and West 1987). Never below the problem's noise; magnetometers as
/// they are.
std::vector<InsNoise> long_run_noise(const InsProblem& problem, const InsCost& cost);

/// Of the offsets, in variances of white noise, summed over the axes: what neighbouring intervals have in common
/// (autocovariance at one interval, if certainly positive). Zero for white noise, and for vibration faster than the
/// intervals.
double persistent_variance(const InstrumentFit& fit);

/// True if that would change a gyroscope's or an accelerometer's noise notably.
bool needs_reweighting(const InsProblem& problem, const InsCost& cost);

}  // namespace kinfer
