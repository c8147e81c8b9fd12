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
#include <optional>
#include <vector>

#include "kinfer/base/observer.hpp"
#include "kinfer/base/stop.hpp"
#include "kinfer/linalg/normal_equations.hpp"
#include "kinfer/linalg/types.hpp"
#include "kinfer/search/least_squares/loss.hpp"

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

/// Whether a step whose predicted decrease is below the cost tolerance is still evaluated.
enum class FinalStep { evaluated, skipped };

struct LeastSquaresOptions {
  int max_iterations = 100;       ///< trial steps, accepted or not
  double cost_tolerance = 1e-14;  ///< ends when the actual and the predicted relative decrease are below
  double step_tolerance = 1e-10;  ///< ends after a step that is shorter, relative to the norm of the scaled unknowns
  double gradient_tolerance = 1e-12;  ///< ends when every |cos(column of J, r)| is less
  double target_cost = 0.0;           ///< ends when the cost is not above it
  Loss loss = Loss::none;
  double loss_scale = 1.0;  ///< [sigma] the loss acts on blocks of k rows with |r| > loss_scale √k
  FinalStep final_step = FinalStep::evaluated;  ///< saved: one evaluation less; accurate to the tolerance only
  double initial_damping = 1e-4;  ///< mu at the start as a fraction of the largest curvature; large: shorter first step
  /// Typical size of each unknown (> 0), its tolerance for instance, by which the damping is scaled. Default: the
  /// reciprocal of the largest column norm of J so far.
  std::optional<VectorXd> scale{};
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
