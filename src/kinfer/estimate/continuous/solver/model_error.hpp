// SPDX-License-Identifier: Apache-2.0
// Covariance of the global parameters with what the residuals say about the model itself.
//
// 1. The sandwich (covariance.hpp) sees the errors that the splines leave over. An error of a rate about the axis of a
//    joint disappears in the joint's position, and an error of a force in lever arms.
// 2. Long-run noise (noise_update.hpp): residuals that stay alike for many intervals are worth fewer samples.
// 3. Information that the noise of the trajectory simulates does not count (noise_information.hpp).
// 4. Considered errors (Schmidt 1966): each instrument measures (I + E) truth, E with independent elements of the size
//    that its persistent residuals have relative to its signal. E is not estimated: the fit would take the errors of
//    any other model for it. Its effect on the estimate enters the covariance. Where a sensor's grade could not be
//    told from the recording, E is as large as a scale error of the assumed grade besides.
// Where the model is right, the residuals are white, 2. and 4. vanish, and the covariance is that of the model.
#pragma once

#include "kinfer/estimate/continuous/solver/covariance.hpp"

namespace kinfer {

/// Factor from the persistent residuals to the considered errors: lever arms, joint positions and biases have absorbed
/// the rest. Larger widens the intervals of machines that do not fit the model. Set on test 1 of a pendulum with mounts
/// that give way (two lengths); held on tests 2 and 3 (docs/development/results.md).
inline constexpr double considered_over_persistent = 3.0;

/// Larger considered scale errors are no scale errors: a sensor that hardly moves has residuals of another kind.
inline constexpr double max_considered_scale = 0.1;

/// Scale errors that are considered of every instrument, whatever its residuals say.
struct AssumedScale {
  double gyroscope = 0.0, accelerometer = 0.0;
};

/// At a fit with this cost. `inflation` is what the sandwich adds. Empty if the information matrix is not positive
/// definite.
std::optional<InsCovariance> covariance_with_model_error(InsProblem& problem, const InsLayout& layout,
                                                         const InsUnknowns& x, const InsCost& cost,
                                                         const AssumedScale& assumed, int threads);

/// Of each sensor: scale errors as large as what the model does not explain of the motion.
struct ConsideredScale {
  double gyroscope = 0.0, accelerometer = 0.0;
};
std::vector<ConsideredScale> considered_scales(const InsProblem& problem, const InsCost& cost);

/// How far a scale matrix may be off because the motion that it multiplies is itself known with noise only: for the
/// column of each axis, the variance of the noise over that of the signal (regression dilution; Fuller 1987), at
/// most 1. An axis that hardly turns tells nothing of its scale.
Vec3 regression_dilution(const std::vector<InsBlock>& blocks, double noise);

/// The global parameters, were the noise white with the long-run variance of the residuals: one step from x, and their
/// covariance.
struct LongRunEstimate {
  VectorXd step;
  MatrixXd covariance;
};
std::optional<LongRunEstimate> long_run_estimate(InsProblem& problem, const InsLayout& layout, const InsUnknowns& x,
                                                 const InsCost& cost, int threads);

}  // namespace kinfer
