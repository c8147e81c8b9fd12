// The continuous-time batch estimate: robust nonlinear least squares over a whole recording at once, by
// Levenberg-Marquardt on a bordered band. Cost and memory grow linearly with the recording.
#pragma once

#include "kinfer/base/observer.hpp"
#include "kinfer/base/stop.hpp"
#include "kinfer/estimate/ins_cost.hpp"

namespace kinfer {

struct InsFitOptions {
  int iterations = 60;           ///< in all
  int settling = 3;              ///< of these, first, for the readings of the joints alone
  int rounds = 6;                ///< most of them between which the instruments are weighed anew
  double least_decrease = 1e-2;  ///< of the cost, in squared sigmas: a step of a tenth of a sigma is convergence
  int threads = 0;
};

struct InsFit {
  InsUnknowns unknowns;
  InsLayout layout;
  InsCost cost;
  Stop stop = Stop::budget_spent;
  int iterations = 0;
};

/// From `start`: first the readings of the joints alone, then everything. In rounds: each begins by giving the
/// instruments the noise that their residuals show, which `problem` then holds; so a poor start counts as noise first,
/// and what the model cannot explain for good does so in the end.
InsFit fit_ins(InsProblem& problem, const InsUnknowns& start, const InsFitOptions& options,
               const Observer& observer = {});

}  // namespace kinfer
