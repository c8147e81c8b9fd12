// SPDX-License-Identifier: Apache-2.0
// Continuous-time batch estimation: robust nonlinear least squares over a whole recording, by Levenberg-Marquardt with
// a bordered band matrix. Time and memory grow linearly with the length of the recording.
#pragma once

#include "kinfer/base/observer.hpp"
#include "kinfer/base/stop.hpp"
#include "kinfer/estimate/continuous/solver/cost.hpp"

namespace kinfer {

struct InsFitOptions {
  int iterations = 60;            ///< in all
  int trajectory_iterations = 3;  ///< the first of these, for the joint trajectories only
  int reweighting_rounds = 6;     ///< at most; the instruments are reweighted between rounds
  double least_decrease = 1e-2;   ///< of the cost [sigma²]: converged at a step of a tenth of a sigma
  int threads = 0;
};

struct InsFit {
  InsUnknowns unknowns;
  InsLayout layout;
  InsCost cost;
  Stop stop = Stop::budget_spent;
  int iterations = 0;
};

/// From `start`: first the joint trajectories only, then all unknowns. Each round begins by setting the instruments'
/// noise in `problem` from their residuals: a poor start counts as noise at first, and so does in the end what the
/// model cannot explain.
InsFit fit_ins(InsProblem& problem, const InsUnknowns& start, const InsFitOptions& options,
               const Observer& observer = {});

}  // namespace kinfer
