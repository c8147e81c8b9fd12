// SPDX-License-Identifier: Apache-2.0
// Covariance of the global parameters, from the noise model and by the sandwich estimator.
//
// Model: C = (information + prior)⁻¹ with the spline coefficients marginalised (Schur complement). Sandwich (White
// 1982, with time blocks for correlated model errors, Newey and West 1987): C (M + P) C, with M the sum of outer
// products of the gradients, each summed over a block of some seconds, and P the prior information. If the model is
// right, M + P estimates C⁻¹ and both agree.
#pragma once

#include "kinfer/estimate/continuous/solver/cost.hpp"

namespace kinfer {

struct InsCovariance {
  MatrixXd model;      ///< global parameters x global parameters
  VectorXd inflation;  ///< sandwich variance over model variance, one per global parameter
};

class InsSystem;

/// Empty if the information matrix is not positive definite. `block` [s]: length of the sandwich's time blocks.
std::optional<InsCovariance> covariance_of(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x,
                                           int threads, double block = 2.0);

/// The same from an undamped system; model_covariance leaves out the sandwich (inflation 1).
std::optional<InsCovariance> covariance_of(const InsSystem& system, double block = 2.0);
std::optional<InsCovariance> model_covariance(const InsSystem& system);

}  // namespace kinfer
