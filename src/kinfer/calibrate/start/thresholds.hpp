// SPDX-License-Identifier: Apache-2.0
// Thresholds of the initial estimates. The data on which they were set are not recorded.
#pragma once

#include <cstddef>

#include "kinfer/base/angle.hpp"

namespace kinfer::calibrate::thresholds {

// ---- circle_point_analysis.cpp ----
inline constexpr double min_motion = 1e-4;             ///< [rad], [m] a joint that moves less counts as at rest
inline constexpr double parallel_axes = 5.0 * degree;  ///< [rad] closer axes have no well-defined common perpendicular
inline constexpr std::size_t min_marked_points = 4;    ///< of a sweep that the file marks
inline constexpr std::size_t min_run_rows = 5;         ///< of a sweep that is found by its rows
inline constexpr double min_run_motion = 10.0 * degree;  ///< [rad] smaller finds shorter sweeps, with worse circles

// ---- initial_frames.cpp ----
/// [1] of the noise that explains the measurements with the guess before: another frame is taken below it. Smaller
/// keeps the file's own.
inline constexpr double better_guess = 0.7;
/// [m], [rad], [m/s²] no instrument is better; smaller residuals are all alike.
inline constexpr double smallest_residual = 1e-6;
inline constexpr double max_relative_rotation = 3.0;    ///< [rad] near 180 degrees the sign of a rotation is arbitrary
inline constexpr std::size_t paired_orientations = 60;  ///< the number of pairs grows with the square
inline constexpr int start_rows = 300;                  ///< determine a frame as well as all rows

// ---- local_poe.cpp: random starts ----
inline constexpr std::size_t starts_per_batch = 8, max_batches = 8;
/// [1] of the points' spread: a larger median error is no solution.
inline constexpr double explained_spread = 0.01;
inline constexpr double agreeing_ratio = 1.2;  ///< [1] of the least median error: the same solution
inline constexpr int enough_agreeing = 3;      ///< so many starts do not agree by chance
inline constexpr int refinement_rounds = 20, final_rounds = 10, refinement_patience = 6;
inline constexpr std::size_t min_start_rows = 40;  ///< enough to distinguish a right optimum from a wrong one

// ---- unknown_robot.cpp ----
/// [m], [rad] resolution of a data sheet, to which an unknown robot is rounded.
inline constexpr double sheet_length = 1e-3, sheet_angle = 1.0 * degree;
inline constexpr double base_length = 1e-2;        ///< [m] resolution of the base
inline constexpr double intersecting_axes = 1e-3;  ///< [m] below this, drawings show axes as intersecting
/// [m], [rad] tolerances of the rounded model.
inline constexpr double rounded_length = 1e-3, rounded_angle = 0.7 * degree, rounded_tool = 5e-3;

}  // namespace kinfer::calibrate::thresholds
