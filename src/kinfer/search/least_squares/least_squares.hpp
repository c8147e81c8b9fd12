// SPDX-License-Identifier: Apache-2.0
// Dense nonlinear least squares: Levenberg-Marquardt with robust losses.
//
//   minimise  cost(x) = Σ_blocks rho(|r_b(x)|²) + Σ_plain r_i(x)²          (no factor 1/2)
//
// A step solves (JᵀWJ + mu D⁻²) dx = −JᵀWr; D scales the unknowns (Marquardt 1963, Moré 1978), mu follows the gain
// ratio (Nielsen 1999), W are the first-order weights rho' of the loss (iteratively re-weighted least squares). A step
// is accepted only if the robust cost itself falls. Directions that no residual depends on keep their start values.
#pragma once

#include <functional>
#include <vector>

#include "kinfer/base/observer.hpp"
#include "kinfer/base/stop.hpp"
#include "kinfer/linalg/normal_equations.hpp"
#include "kinfer/linalg/types.hpp"
#include "kinfer/search/least_squares/options.hpp"

namespace kinfer {

/// Residuals in units of their standard deviations, as a function of the unknowns.
struct Residuals {
  Eigen::Index unknowns = 0;
  Eigen::Index rows = 0;
  std::vector<int> blocks{};  ///< sizes of consecutive blocks of rows that share one robust weight (3 for a point),
                              ///< from row 0 on; the rows after them (priors) carry no loss
  /// Fills r (rows) and, where it is not null, jacobian (rows x unknowns, dr/dx). Both are passed with their
  /// size and arbitrary contents. Non-finite numbers (outside the domain) count as infinite cost.
  std::function<void(ConstVectorRef x, VectorXd& r, MatrixXd* jacobian)> evaluate{};
};

/// A sum of squares given by its cost and its normal equations only, without a Jacobian.
struct NormalProblem {
  Eigen::Index unknowns = 0;
  std::function<double(ConstVectorRef x)> cost{};  ///< Σ r²; not finite outside its domain
  /// Σ r², and Jᵀ J (lower half) and Jᵀ r.
  std::function<double(ConstVectorRef x, NormalEquations& normal)> linearise{};
};

/// Numbers of evaluations of a problem.
struct EvaluationCounts {
  int evaluations = 0, jacobians = 0, not_finite = 0;
};

struct LeastSquaresOutcome {
  VectorXd x{};                   ///< best point
  double cost = 0.0;              ///< at x: Σ rho + Σ plain r², without 1/2
  VectorXd residuals{};           ///< at x, not weighted by the loss
  MatrixXd jacobian{};            ///< at x, not weighted by the loss
  VectorXd block_weights{};       ///< rho' of each block at x, 0 .. 1; ones without a loss
  NormalEquations normal{};       ///< at x, of a NormalProblem, which leaves the three above empty; empty itself if the
                                  ///< target cost was reached, where no linearisation is made
  std::vector<double> history{};  ///< cost at the start and after each iteration; never rises
  Stop stop = Stop::budget_spent;
  int iterations = 0;   ///< trial steps
  int evaluations = 0;  ///< calls of evaluate
  int jacobians = 0;    ///< those of them with a Jacobian
  int not_finite = 0;   ///< those of them that gave a non-finite number
};

/// Minimises from `start` (unknowns, with finite cost, else Stop::not_finite). Notifies the observer each iteration.
LeastSquaresOutcome least_squares(const Residuals& problem, ConstVectorRef start,
                                  const LeastSquaresOptions& options = {}, const Observer& observer = {});

/// The same by normal equations; options.loss must be none. A direction whose eigenvalue of JᵀJ is below rounding keeps
/// its start value.
LeastSquaresOutcome least_squares(const NormalProblem& problem, ConstVectorRef start,
                                  const LeastSquaresOptions& options = {}, const Observer& observer = {});

}  // namespace kinfer
