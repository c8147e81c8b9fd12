// SPDX-License-Identifier: Apache-2.0
#include "kinfer/words/status.hpp"

#include "kinfer/base/expect.hpp"
#include "kinfer/words/language.hpp"

namespace kinfer::words {

std::string sentence(Stop stop) {
  switch (stop) {
    case Stop::converged_cost:
      return phrase("converged_cost", "converged: the cost no longer falls");
    case Stop::converged_step:
      return phrase("converged_step", "converged: the step is below the accuracy of the unknowns");
    case Stop::converged_gradient:
      return phrase("converged_gradient", "converged: the gradient is zero to rounding");
    case Stop::target_reached:
      return phrase("target_reached", "the target cost is reached");
    case Stop::budget_spent:
      return phrase("budget_spent", "stopped: the budget of iterations or evaluations is spent");
    case Stop::stalled:
      return phrase("stalled", "stopped: no damped step lowers the cost");
    case Stop::not_finite:
      return phrase("not_finite", "stopped: the start has no finite cost");
    case Stop::cancelled:
      return phrase("cancelled", "stopped on request");
  }
  KINFER_EXPECT(false, "unknown Stop");
}

std::string sentence(InverseStatus status) {
  switch (status) {
    case InverseStatus::reached:
      return phrase("reached", "the tool is at its target");
    case InverseStatus::unreachable:
      return phrase("unreachable",
                    "the target is out of reach from this start: no small change of the joint positions brings the "
                    "tool closer");
    case InverseStatus::at_limit:
      return phrase("at_limit", "a joint at its limit keeps the tool from its target");
    case InverseStatus::near_singular:
      return phrase("near_singular", "the tool did not reach its target: near a kinematic singularity");
    case InverseStatus::iteration_limit:
      return phrase("iteration_limit", "the tool did not reach its target within the allowed number of iterations");
  }
  KINFER_EXPECT(false, "unknown InverseStatus");
}

}  // namespace kinfer::words
