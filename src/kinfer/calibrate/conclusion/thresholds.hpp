// SPDX-License-Identifier: Apache-2.0
// Thresholds of the verdict and of the recommendations. The data on which they were set are not recorded.
// What half and double of those in KINFER_THRESHOLD do to the figures: docs/development/thresholds.md.
#pragma once

#include <Eigen/Core>

#include "kinfer/base/threshold.hpp"

namespace kinfer::calibrate::thresholds {

/// [1] held-out rms error over the expected one: above it, some effect is not modelled. Larger accepts worse models.
KINFER_THRESHOLD(calibrate, expectation_ratio, 3.0);
/// [1] rms error of the final fit on its rows over that of the validation fits on held-out rows: above it, the final
/// fit converged to another solution than the validated one.
inline constexpr double same_solution_ratio = 1.5;
/// [1] held-out mean error over that of the fitted rows, without a data sheet: above it, the model is overfitted.
inline constexpr double generalisation_ratio = 3.0;
/// Probability with which a model that is no better than the nominal one looks as much better on the held-out poses:
/// above it, the improvement is not proven.
inline constexpr double unproven_chance = 0.05;
/// [1] of the tolerances: a robot that is further off is perhaps another one, or its data are in other units.
inline constexpr double strange_tolerance_factor = 100.0;
/// [1] of the nominal tool's motion along a direction: a tool that moves by less does not move. As of points that are
/// one point (diagnosis); no robot of 276 simulated sets of all instruments is below it.
inline constexpr double no_motion = 1e-3;
/// Probability that the offset of any unchanged joint is called moved (two-sided, family-wise).
inline constexpr double moved_offset_risk = 0.01;

inline constexpr double misfit_chi2 = 4.0;  ///< [1] chi2/n: the residuals are twice the instrument's noise
inline constexpr double enough_rotation = 1.0, enough_translation = 0.1;  ///< [rad], [m] range of a joint's positions
/// [1] of the predicted error over the poses: a workspace point above it is worth more poses.
inline constexpr double uncertain_ratio = 1.5;
inline constexpr Eigen::Index enough_poses = 60, least_more_poses = 10;
inline constexpr int workspace_points = 500;  ///< samples of the predicted error; more: finer, slower

}  // namespace kinfer::calibrate::thresholds
