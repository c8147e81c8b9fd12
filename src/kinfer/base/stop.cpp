// SPDX-License-Identifier: Apache-2.0
#include "kinfer/base/stop.hpp"

#include "kinfer/base/expect.hpp"

namespace kinfer {
std::string_view name(Stop stop) {
  switch (stop) {
    case Stop::converged_cost:
      return "converged_cost";
    case Stop::converged_step:
      return "converged_step";
    case Stop::converged_gradient:
      return "converged_gradient";
    case Stop::target_reached:
      return "target_reached";
    case Stop::budget_spent:
      return "budget_spent";
    case Stop::stalled:
      return "stalled";
    case Stop::not_finite:
      return "not_finite";
    case Stop::cancelled:
      return "cancelled";
  }
  KINFER_EXPECT(false, "unknown Stop");
}

bool converged(Stop stop) {
  return stop <= Stop::target_reached;
}

}  // namespace kinfer
