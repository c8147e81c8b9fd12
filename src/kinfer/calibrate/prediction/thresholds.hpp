// SPDX-License-Identifier: Apache-2.0
// Thresholds of the uncertainty of predictions. Set on halves of UR10 B and C, the positioner, FR3 and 30 simulated
// robots.
#pragma once

#include <cstddef>

namespace kinfer::calibrate::thresholds {

// ---- model_error.cpp: the uncertainty of predictions ----
inline constexpr double ellipsoid_content = 0.95;       ///< of the ellipsoids that the model error is set by
inline constexpr double trusted_quantile_rows = 100.0;  ///< rows whose 95 % point counts as much as their mean square
inline constexpr double clipped_length = 25.0;  ///< [1] of the median square: larger residuals are shortened to it
inline constexpr double least_excess = 1e-2;    ///< [1] of the mean square: model error in a direction without excess
inline constexpr double largest_model_error_factor = 1e6;
inline constexpr std::size_t min_model_error_rows = 8;
inline constexpr int region_rows = 100;                 ///< joint positions that stand for the fitted region
inline constexpr double region_part = 0.95;             ///< of the fitted rows that lie within reach of these
inline constexpr std::size_t region_fit_rows = 400;     ///< of the fits to parts of the joint space; more: slower
inline constexpr double edge_over_measured = 1.5;       ///< [1] one-sidedness of the edge over that of the fitted rows
inline constexpr double largest_outside_factor = 30.0;  ///< [1] of what explains the mean excess outside
inline constexpr int outside_rounds = 3;
inline constexpr double default_outside = 9.0;  ///< [1] of the error inside, where no region could be held out
inline constexpr double least_noise = 0.1;      ///< [1] of the variance of the residuals: an instrument has some

}  // namespace kinfer::calibrate::thresholds
