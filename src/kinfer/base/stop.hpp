// SPDX-License-Identifier: Apache-2.0
// Why an iteration ended: an enumerator for code, and a sentence for the user.
#pragma once

#include <string_view>

namespace kinfer {

enum class Stop {
  converged_cost,      ///< the cost no longer falls
  converged_step,      ///< the step is below the accuracy of the unknowns
  converged_gradient,  ///< the gradient is zero to rounding
  target_reached,      ///< the target cost is reached
  budget_spent,        ///< iterations or evaluations used up
  stalled,             ///< no damped step lowers the cost
  not_finite,          ///< the start has no finite cost
  cancelled,           ///< the observer requested a stop
};

std::string_view name(Stop stop);  ///< as in evidence.json: "converged_cost"
bool converged(Stop stop);         ///< true for the three converged_* and for target_reached

}  // namespace kinfer
