// SPDX-License-Identifier: Apache-2.0
#include "kinfer/base/stop.hpp"

#include "kinfer/base/expect.hpp"

namespace kinfer {
namespace {

struct StopText {
  std::string_view name, sentence;
};

StopText stop_text(Stop stop) {
  switch (stop) {
    case Stop::converged_cost:
      return {"converged_cost", "converged: the cost no longer falls"};
    case Stop::converged_step:
      return {"converged_step", "converged: the step is below the accuracy of the unknowns"};
    case Stop::converged_gradient:
      return {"converged_gradient", "converged: the gradient is zero to rounding"};
    case Stop::target_reached:
      return {"target_reached", "the target cost is reached"};
    case Stop::budget_spent:
      return {"budget_spent", "stopped: the budget of iterations or evaluations is spent"};
    case Stop::stalled:
      return {"stalled", "stopped: no damped step lowers the cost"};
    case Stop::not_finite:
      return {"not_finite", "stopped: the start has no finite cost"};
    case Stop::cancelled:
      return {"cancelled", "stopped on request"};
  }
  KINFER_EXPECT(false, "unknown Stop");
}

}  // namespace

std::string_view name(Stop stop) {
  return stop_text(stop).name;
}
std::string_view sentence(Stop stop) {
  return stop_text(stop).sentence;
}
bool converged(Stop stop) {
  return stop <= Stop::target_reached;
}

}  // namespace kinfer
