// SPDX-License-Identifier: Apache-2.0
// Termination, damping and loss of a least-squares fit.
#pragma once

#include <optional>

#include "kinfer/linalg/types.hpp"
#include "kinfer/search/least_squares/loss.hpp"

namespace kinfer {

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
  FinalStep final_step = FinalStep::evaluated;  ///< skipped: one evaluation less; accurate to the tolerance only
  double initial_damping = 1e-4;  ///< mu at the start as a fraction of the largest curvature; large: shorter first step
  /// Typical size of each unknown (> 0), its tolerance for instance, by which the damping is scaled. Default: the
  /// reciprocal of the largest column norm of J so far.
  std::optional<VectorXd> scale{};
};

}  // namespace kinfer
