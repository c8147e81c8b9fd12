// SPDX-License-Identifier: Apache-2.0
// Thresholds of the least-squares fit. The data on which they were set are not recorded unless stated.
#pragma once

#include "kinfer/base/angle.hpp"

namespace kinfer::calibrate::thresholds {

/// [1] tolerances within which a frame of the robot file agrees with the data and is kept. Larger trusts the file more.
inline constexpr double frame_agreement = 3.0;
/// [1] of the instrument's sigma: a larger noise level of the fit starts trials with larger tolerances.
inline constexpr double noise_ratio = 2.0;
inline constexpr double tolerance_factors[] = {10.0, 100.0, 1000.0};  ///< [1] tried then
/// [1] factor on the tolerance of the tool length in an offset refit: wrong joint offsets disturb the estimated tool.
inline constexpr double refit_tool_factor = 10.0;
/// [1] of the reach: a larger residual means that the fit has not converged. Larger: fewer restarts.
inline constexpr double unconverged_residual = 2e-3;
inline constexpr int random_starts = 20;  ///< more: slower, finds the solution from worse nominal models
/// [m], [rad] perturbation of a random start: Levenberg-Marquardt converges from these errors.
inline constexpr double perturbation_length = 0.1, perturbation_angle = 20.0 * degree;
/// [1] odds against a robot's being one of the population, by its data, from which on its own tolerances are used. Set
/// by reasoning: who names a population is taken to err once in a hundred times.
inline constexpr double foreign_odds = 100.0;

}  // namespace kinfer::calibrate::thresholds
