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

// ---- noise levels over which the relevance of terms is marginalised, where the noise is not stated ----
/// More residuals than parameters by that: the noise level is known to 5 % and taken as estimated.
inline constexpr double most_uncertain_redundancy = 200.0;
/// [1] of the noise level of geometry alone: terms explain no more.
inline constexpr double lowest_noise_part = 1e-2;
inline constexpr double noise_level_step = 2.0;   ///< [sd] of the logarithm; the trapezium rule errs by 1 % at that
inline constexpr double impossible_noise = 10.0;  ///< log likelihood ratio from which on levels are left out

// ---- proof of a model by its held-out errors ----
/// [standard errors] of the mean increase that refuse a term; larger trusts the marginal likelihood more.
KINFER_THRESHOLD(calibrate, harm_significance, 2.0);
/// [1] of the 95 or 99 % point: smaller increases are no harm.
KINFER_THRESHOLD(calibrate, tail_ratio, 1.05);
/// [1] bootstrap probability of an increase of that point that refuses a term.
inline constexpr double harm_probability = 0.975;
/// [1] of future poses expected as far beyond the fitted ones as the extrapolation splits; larger refuses more terms.
/// Set on UR10 A: with 0.1, gear harmonics are accepted that lower the held-out mean by 13 % and put one pose 3.7 mm
/// off.
KINFER_THRESHOLD(calibrate, part_beyond, 0.25);
inline constexpr int bootstrap_draws = 200;  ///< more: slower, the probability more accurate than 1 %
/// Rows to fit of an extrapolation split; more: slower. Set for the time on UR10 A, whose terms do not depend on it.
inline constexpr std::size_t extrapolation_rows = 1500;

// ---- gear harmonics in the spectrum of the residuals ----
inline constexpr double lowest_order = 3.0, highest_order = 260.0;  ///< [1/rev] orders tested
inline constexpr double min_spectrum_range = 0.5;                   ///< [rad] joint range that a spectrum needs
/// [1] of the resolution 2π/range; smaller: finer, slower.
inline constexpr double order_step = 0.25;
inline constexpr double integer_order_ratio = 0.97;     ///< [1] of the improvement: above it, the order is rounded
inline constexpr std::size_t min_spectrum_points = 60;  ///< too few below that for a spectrum
/// [Δχ²] above the expected maximum of pure noise; larger finds fewer lines.
KINFER_THRESHOLD(calibrate, spectral_margin, 20.0);
inline constexpr int max_spectral_lines = 24;
/// Rows from which series and lines are compared on a part of them; more: slower. Set for the time on UR10 A and B.
inline constexpr std::size_t compared_rows = 600;
inline constexpr std::size_t gears_alone_rows = 1000;  ///< of the fit of gears alone; more: slower

// ---- approximate masses: only their ratios matter ----
inline constexpr double mass_per_metre = 15.0, min_link_mass = 1.0, tool_mass = 2.0;  ///< [kg/m], [kg], [kg]

}  // namespace kinfer::calibrate::thresholds
