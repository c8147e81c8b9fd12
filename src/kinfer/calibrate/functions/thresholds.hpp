// SPDX-License-Identifier: Apache-2.0
// Thresholds and priors of series of harmonics (set beside UR10 A, B and C) and displacement fields (set on halves of
// MUKCa 1 and 2, FR3, the positioner and 60 simulated robots).
#pragma once

#include <array>
#include <cstddef>

namespace kinfer::calibrate::thresholds {

/// [rad] of the coefficients: where their size is sought first, and at most.
inline constexpr double first_series_size = 1e-4, largest_series_size = 1e-3;
inline constexpr double typical_series_size =
    0.2e-3;                                           ///< [rad] scale of the prior of that size, as of single harmonics
inline constexpr double min_series_range = 0.5;       ///< [rad] of the joint; with less, it has no series
inline constexpr std::size_t min_series_points = 60;  ///< too few below that for a function of any form
inline constexpr int series_rounds = 5;             ///< at most, of size and noise level in turn; usually three suffice
inline constexpr double settled_noise = 0.02;       ///< [1] relative change of the noise level that ends them
inline constexpr double least_series_noise = 1e-6;  ///< [1] of the variance before: noise beside series
/// [1] factor with which another joint follows one that then has no series; what a coupling term finds is smaller.
inline constexpr double followed = 0.05;

inline constexpr int field_points = 120;   ///< inducing points of a field, at most
inline constexpr int min_field_rows = 20;  ///< with fewer, no field was ever supported
inline constexpr int field_rows = 600;     ///< from which a field is sought, at most
/// [1] of the joints' standard deviations: distances over which a field changes.
inline constexpr std::array<double, 3> field_lengths{0.5, 1.0, 2.0};
/// [1] of the noise: sizes of a field, and of its variance: noise beside it.
inline constexpr double least_field_size = 1e-2, largest_field_size = 1e2;
inline constexpr double least_field_noise = 0.04, largest_field_noise = 2.6;
inline constexpr int field_sizes = 49, field_noises = 41;  ///< that are tried
inline constexpr double field_rounding = 1e-12;   ///< [1] of the largest information of a value: what is added to all
inline constexpr double least_shown_noise = 0.7;  ///< [1] of the stated variance: orientations with less weigh no field
inline constexpr double least_estimated_noise = 0.1;     ///< [1] the same where the variance is that of the residuals
inline constexpr double least_noise_beside_field = 0.5;  ///< [1] of that by the marginal likelihood
inline constexpr int field_rounds = 5;                   ///< at most, of the field and noise level in turn

}  // namespace kinfer::calibrate::thresholds
