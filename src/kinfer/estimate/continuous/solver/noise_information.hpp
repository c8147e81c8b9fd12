// SPDX-License-Identifier: Apache-2.0
// Information about the joints that comes from the noise of the estimated trajectory.
//
// The normal equations take the estimated trajectory for the true one: a lever arm on a body that does not turn seems
// to be seen by the accelerations of a rotation that is only noise. The exact Hessian has another term in the block
// between the spline coefficients s and the parameters h: W = −Σ r ∂²f / ∂s ∂h with the residuals r. Its part of the
// Schur complement, Wᵀ H⁻¹ W, is in the mean the information that the noise of s simulates (errors in variables;
// Fuller 1987).
#pragma once

#include <vector>

#include "kinfer/estimate/continuous/model/problem.hpp"

namespace kinfer {

struct NoiseInformation {
  std::vector<Eigen::Index> parameters;  ///< global parameters of all joints
  MatrixXd information;                  ///< Wᵀ H⁻¹ W of these
  double intervals = 0.0;                ///< of the splines
};

NoiseInformation noise_information(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x,
                                   int threads);

/// Takes it out of a covariance of the global parameters. `white`: the covariance whose information has that share;
/// `prior`: information that remains. Of information I in a direction the share s is from noise: the cost is curved by
/// (1 − s) I only, but its gradient has the variance I, so that of the estimate is 1 / ((1 − s)² I) (Fuller 1987).
void discount(MatrixXd& covariance, ConstMatrixRef white, ConstMatrixRef prior, const NoiseInformation& noise);

}  // namespace kinfer
