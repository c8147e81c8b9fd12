// The continuous-time batch estimate: robust nonlinear least squares over a whole recording at once, by
// Levenberg-Marquardt on a bordered band. Cost and memory grow linearly with the recording.
#pragma once

#include "kinfer/base/observer.hpp"
#include "kinfer/base/stop.hpp"
#include "kinfer/estimate/ins_linearisation.hpp"

namespace kinfer {

struct InsFitOptions {
  int iterations = 60;
  double least_decrease = 1e-7;  ///< of the cost: less is convergence
  int threads = 0;
};

struct InsFit {
  InsUnknowns unknowns;
  InsLayout layout;
  InsCost cost;
  Stop stop = Stop::budget_spent;
  int iterations = 0;
};

/// From `start`: first the readings of the joints alone, then everything.
InsFit fit_ins(const InsProblem& problem, const InsUnknowns& start, const InsFitOptions& options,
               const Observer& observer = {});

}  // namespace kinfer
