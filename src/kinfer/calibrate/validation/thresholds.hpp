// SPDX-License-Identifier: Apache-2.0
// Thresholds of the validation. The data on which they were set are not recorded unless stated.
// What half and double of those in KINFER_THRESHOLD do to the figures: docs/development/thresholds.md.
#pragma once

#include <cstddef>

#include "kinfer/base/angle.hpp"
#include "kinfer/base/threshold.hpp"

namespace kinfer::calibrate::thresholds {

inline constexpr int default_folds = 5;        ///< of a cross-validation; more: slower, fits closer to the final one
inline constexpr int leave_one_out_rows = 12;  ///< an offset refit with at most so many rows holds out one at a time
/// Each pose gives at most six equations; base and tool alone are nine unknowns, and one row must validate the result.
inline constexpr int min_fitted_rows = 4;
inline constexpr int min_training_poses = 3;

/// [sigma] gross error of the richest model: twice the largest residual by chance among a thousand valid rows.
KINFER_THRESHOLD(calibrate, gross_sigmas, 11.0);
/// [1] error by the geometric over that by the richer model; below it, the richer model is at fault and not the row.
KINFER_THRESHOLD(calibrate, geometric_error_ratio, 0.5);
/// [sigma] a row with a smaller error is explained; exceeded by chance by one point in a thousand.
inline constexpr double explained_sigmas = 4.0;
/// One held-out row in so many with a gross error: the model is at fault, and no row is excluded.
inline constexpr std::size_t max_gross_part = 3;

/// [rad] of tilts, orientations and directions whose noise is not stated: what is further off is no noise. Set between
/// 1 deg, of the worst instruments that calibrate anything, and the 57 deg of directions at random.
inline constexpr double unstated_noise_angle = 10.0 * degree;
/// Measurements from which on their kind is judged as a whole; fewer are outliers at most.
inline constexpr int min_judged_measurements = 4;
/// Measurements of a kind from which on their errors judge a model: the mean length of so many errors of a point, each
/// 0.42 of it about the mean, is known to 15 %. Of 8 tracker points beside hundreds of sights and more, errors are
/// judged as of points alone.
inline constexpr std::size_t min_judging_measurements = 8;

// ---- extrapolation_splits.cpp ----
/// [1] of the rows at each end of a principal direction, held out together; larger: farther beyond the fitted poses.
inline constexpr double extrapolation_part = 0.25;
/// Rows left to fit on each side of an extrapolation split; with fewer, extrapolation is not tested.
inline constexpr int min_extrapolation_rows = 15;

}  // namespace kinfer::calibrate::thresholds
