// SPDX-License-Identifier: Apache-2.0
// Thresholds and priors of model selection. The data on which they were set are not recorded unless stated.
// What half and double of those in KINFER_THRESHOLD do to the figures: docs/development/thresholds.md.
#pragma once

#include <cstddef>

#include "kinfer/base/threshold.hpp"

namespace kinfer::calibrate::thresholds {

// ---- priors of the terms, about zero or the file's value; larger accepts larger errors ----
inline constexpr double coupling_prior = 1e-2;    ///< [rad/rad] ratios are known better than the couplings' existence
inline constexpr double harmonic_prior = 0.2e-3;  ///< [rad] errors of eccentric gears and encoder rings are smaller
inline constexpr double backlash_prior = 0.3e-3;  ///< [rad], or [m] of prismatic joints
inline constexpr double expansion_prior = 20e-6;  ///< [1/K] between steel and aluminium

/// [K] 5-95 % range of the temperatures; with less, thermal expansion is not tested.
inline constexpr double min_temperature_range = 1.0;

// ---- acceptance of a term by its held-out errors ----
/// [standard errors] of the mean reduction; larger accepts fewer terms. Not corrected for the number of terms tested.
KINFER_THRESHOLD(calibrate, min_significance, 2.5);
/// [1] of the mean error; larger accepts fewer terms.
KINFER_THRESHOLD(calibrate, min_reduction, 0.01);
/// [1] of the largest error before, or of the geometric model; larger lets single poses pay for the others.
KINFER_THRESHOLD(calibrate, worst_error_ratio, 1.0);
/// [1] of the mean error beyond the fitted poses; larger accepts terms that only interpolate.
KINFER_THRESHOLD(calibrate, extrapolation_ratio, 1.02);
/// Rows left to fit on each side of an extrapolation split; with fewer, extrapolation is not tested.
inline constexpr int min_extrapolation_rows = 15;

// ---- gear harmonics in the spectrum of the residuals ----
inline constexpr double lowest_order = 3.0, highest_order = 260.0;  ///< [1/rev] orders tested
inline constexpr double min_spectrum_range = 0.5;                   ///< [rad] joint range that a spectrum needs
/// [1] of the resolution 2π/range; smaller: finer, slower.
inline constexpr double order_step = 0.25;
inline constexpr double integer_order_ratio = 0.97;     ///< [1] of the improvement: above it, the order is rounded
inline constexpr std::size_t min_spectrum_points = 60;  ///< too few below that for a spectrum
/// [Δχ²] above the expected maximum of pure noise; larger finds fewer lines.
KINFER_THRESHOLD(calibrate, spectral_margin, 20.0);
inline constexpr int max_spectral_lines = 12;

// ---- approximate masses: only their ratios matter ----
inline constexpr double mass_per_metre = 15.0, min_link_mass = 1.0, tool_mass = 2.0;  ///< [kg/m], [kg], [kg]

}  // namespace kinfer::calibrate::thresholds
