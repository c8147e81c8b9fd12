// SPDX-License-Identifier: Apache-2.0
// Thresholds of the diagnosis of pose sets. The data on which they were set are not recorded unless stated.
#pragma once

#include <cstddef>

#include "kinfer/base/angle.hpp"

namespace kinfer::calibrate::thresholds {

// ---- conventions.cpp: hypotheses about units, signs, offsets and columns ----
inline constexpr std::size_t hypothesis_rows = 40;  ///< rows that a hypothesis is tested on; more: slower, more certain
inline constexpr int min_hypothesis_rows = 8;       ///< base and tool are nine unknowns; the others must discriminate
/// [1] of the points' spread: what base and tool leave of a robot that has their size. In another unit it leaves nearly
/// all of it. Not set on data.
inline constexpr double fitting_part_of_spread = 0.1;
inline constexpr std::size_t beam_width = 4;       ///< sets of hypotheses that are extended; larger: slower, safer
inline constexpr int max_simultaneous_faults = 3;  ///< larger: slower, and more chance explanations
/// [1] of the error without the hypothesis: a plausible explanation must fall below it. Larger accepts more.
inline constexpr double plausible_improvement = 0.2;
/// [1] the same for an explanation whose error exceeds what the tolerances allow. Larger accepts more.
inline constexpr double implausible_improvement = 0.05;
inline constexpr double equivalent_ratio = 1.5;  ///< [1] of the least error: explanations below count as equivalent
inline constexpr double smallest_reach = 0.01, largest_reach = 100.0;  ///< [m] plausible sizes of a robot

// ---- diagnosis_state.cpp: quick fit of base and tool ----
inline constexpr std::size_t min_points_of_quick_fit = 4;
/// [1] of what the nominal model moves: points that move by less are one point. Larger refuses more.
inline constexpr double still_points = 1e-3;
inline constexpr double plausible_error_ratio =
    4.0;  ///< [1] of the expected rms; larger tolerates worse nominal models

// ---- joint_positions.cpp ----
inline constexpr double limit_slack_angle = 1.0 * degree, limit_slack_length = 1e-3;  ///< [rad], [m] beyond a limit
/// [rad], [m] standard deviation of a joint's positions; below, its parameters are nearly confounded with others.
inline constexpr double min_excitation_angle = 5.0 * degree, min_excitation_length = 5e-3;
inline constexpr double rigidity_sigmas = 8.0;  ///< [sigma] of the distance of two targets: beyond any random error
inline constexpr std::size_t min_rigidity_rows = 4;

// ---- row_pairing.cpp ----
inline constexpr int min_pairing_rows = 8;
inline constexpr int min_shifted_run = 4;  ///< rows that one shift explains; smaller finds short runs, and chance ones
inline constexpr int largest_shift = 10;   ///< rows
inline constexpr int max_disagreeing = 5;  ///< at most one row in so many of a run may disagree
inline constexpr double unpaired_ratio = 8.0;  ///< [1] of the median error: beyond any Gaussian error
inline constexpr double min_explained_part =
    0.4;  ///< of all rows; with fewer, the reference model itself is a chance fit
inline constexpr std::size_t min_moved_rows = 8;   ///< rows that show a moved base
inline constexpr std::size_t reference_rows = 80;  ///< rows of the quick fit; more: slower

// ---- orientation_conventions.cpp ----
inline constexpr std::size_t min_orientations = 6;
inline constexpr double max_plausible_angle = 3.0 * degree;  ///< [rad] larger tolerates worse orientations
inline constexpr double orientation_improvement = 0.2;       ///< [1] of the disagreement as read; larger accepts more

// ---- joint_lag.cpp: joint positions that are not those of the measured tool ----
inline constexpr double commanded_equal = 1e-6;    ///< [rad], [m] commanded and measured positions are copies
inline constexpr double settled = 0.05 * degree;   ///< [rad] the arm was at rest
inline constexpr double settled_prismatic = 5e-4;  ///< [m] likewise: as far as `settled` moves a tool 0.6 m away
inline constexpr double unsettled_ratio = 10.0;    ///< [1] of the typical difference; larger names fewer rows
/// Of the mean log likelihood ratio in its standard deviations (one in a thousand by chance), and of the sum: below
/// either, commanded and measured positions explain the points alike.
inline constexpr double min_paired_z = 3.0, min_log_ratio = 5.0;
inline constexpr std::size_t min_lag_rows = 20;
/// t statistic of residuals along the last motion, and their share of the sum of squares that it explains; larger finds
/// less.
inline constexpr double min_lag_t = 5.0, min_lag_part = 0.02;

// ---- motion_regression.cpp ----
inline constexpr double clipped_residual = 5.0;   ///< [1] of the median error: larger residuals are shortened to it
inline constexpr double regression_ridge = 1e-9;  ///< on columns of unit length
inline constexpr double least_own_part = 1e-4;    ///< [1] of the motion's sum of squares that no other column explains

// ---- fit_residuals.cpp ----
inline constexpr std::size_t max_fitted_rows = 400;  ///< more add no information, and cost time before each calibration
inline constexpr std::size_t min_residual_points = 12;  ///< base, tool and joints use up three of four equations
inline constexpr int min_drift_rows = 20;
inline constexpr double step_over_drift = 1.5;  ///< [1] ratio of F statistics: above, a step explains more than a drift
/// F statistic of a rigid motion; 6.4 is chi-squared of six at its one-in-a-million quantile. Larger finds less.
inline constexpr double min_f_statistic = 10.0;
inline constexpr double min_motion_ratio =
    1.5;                                      ///< [1] of the scatter: a smaller motion is hidden by the model's errors
inline constexpr double false_alarms = 1e-3;  ///< outliers by chance per data set, as in the fit
inline constexpr double unfitted_ratio = 1.25;  ///< [1] errors of unfitted rows over the noise level of the fit
inline constexpr int max_outlier_part = 4;      ///< more than one row in so many: the model is at fault

}  // namespace kinfer::calibrate::thresholds
