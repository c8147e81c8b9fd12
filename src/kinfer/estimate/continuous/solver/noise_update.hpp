// SPDX-License-Identifier: Apache-2.0
// Noise of the instruments as estimated from the residuals of a fit: standard deviation and correlation.
#pragma once

#include "kinfer/estimate/continuous/solver/cost.hpp"

namespace kinfer {

/// Sets every instrument's standard deviation from its residuals without outliers, never below the instrument's own
/// noise. True if one of them changed notably.
bool update_noise(InsProblem& problem, const InsCost& cost);

/// The sensors' noise with the excess of blocks that the fit discounts: of the measurements as they were recorded.
std::vector<InsNoise> recorded_noise(const InsProblem& problem, const InsCost& cost);

/// Standard deviations of white noise that has as much power at low frequencies as the residuals: what they are worth
/// as independent samples (long-run variance; Newey and West 1987). Never below the problem's noise.
std::vector<InsNoise> long_run_noise(const InsProblem& problem, const InsCost& cost);

/// Of the offsets, in variances of white noise, summed over the axes: what neighbouring intervals have in common
/// (autocovariance at one interval, if certainly positive). Zero for white noise, and for vibration faster than the
/// intervals.
double persistent_variance(const InstrumentFit& fit);

/// True if update_noise would change a gyroscope's or an accelerometer's noise notably.
bool needs_reweighting(const InsProblem& problem, const InsCost& cost);

}  // namespace kinfer
