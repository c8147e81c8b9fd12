// SPDX-License-Identifier: Apache-2.0
// Thresholds and priors of series of harmonics. Set beside UR10 A, B and C.
#pragma once

#include <cstddef>

namespace kinfer::calibrate::thresholds {

/// [rad] of the coefficients: where their size is sought first, and at most.
inline constexpr double first_series_size = 1e-4, largest_series_size = 1e-3;
inline constexpr double typical_series_size =
    0.2e-3;                                           ///< [rad] scale of the prior of that size, as of single harmonics
inline constexpr double min_series_range = 0.5;       ///< [rad] of the joint; with less, it has no series
inline constexpr std::size_t min_series_points = 60;  ///< too few below that for a function of any form
inline constexpr int series_rounds = 5;        ///< at most, of size and noise level in turn; usually three suffice
inline constexpr double settled_noise = 0.02;  ///< [1] relative change of the noise level that ends them
/// [1] factor with which another joint follows one that then has no series; what a coupling term finds is smaller.
inline constexpr double followed = 0.05;

}  // namespace kinfer::calibrate::thresholds
