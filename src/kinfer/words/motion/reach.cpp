// SPDX-License-Identifier: Apache-2.0
#include "kinfer/words/motion/reach.hpp"

#include "kinfer/base/angle.hpp"
#include "kinfer/words/language.hpp"

namespace kinfer::words {
namespace {

std::string reason(const ReachSolution& solution, const std::vector<std::string>& joint_names) {
  const std::string_view id = name(solution.status);
  std::vector<std::string> limited;
  for (const int k : solution.limited_joints) limited.push_back(joint_names[static_cast<std::size_t>(k)]);
  switch (solution.status) {
    case ReachStatus::reached:
      break;
    case ReachStatus::outside_limits:
      return phrase(id, "only with {} beyond {}", fmt::join(limited, ", "),
                    limited.size() == 1 ? "its limits" : "their limits");
    case ReachStatus::near_singular:
      return phrase(id, "a singular posture is in the way");
    case ReachStatus::out_of_reach:
      return phrase(id, "out of reach");
  }
  return phrase(id, "reached");
}

}  // namespace

std::string summary(const ReachSummary& summary) {
  return phrase("reach", "{} of {} targets are reached", summary.targets - static_cast<int>(summary.unreached.size()),
                summary.targets);
}

std::string unreached_target(int target, const ReachSolution& solution, const std::vector<std::string>& joint_names) {
  return phrase("unreached_target", "target {}: {}; {:.4f} mm and {:.4f} deg are left", target,
                reason(solution, joint_names), 1e3 * solution.position_error, solution.angle_error / degree);
}

}  // namespace kinfer::words
