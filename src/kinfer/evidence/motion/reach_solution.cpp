// SPDX-License-Identifier: Apache-2.0
#include "kinfer/evidence/motion/reach_solution.hpp"

namespace kinfer {

std::string_view name(ReachStatus status) {
  constexpr std::string_view names[] = {"reached", "outside_limits", "near_singular", "out_of_reach"};
  return names[static_cast<int>(status)];
}

ReachSummary summarise(const std::vector<ReachSolution>& solutions) {
  ReachSummary summary{.targets = static_cast<int>(solutions.size())};
  for (std::size_t i = 0; i < solutions.size(); ++i) {
    if (solutions[i].status == ReachStatus::reached)
      summary.postures += static_cast<int>(solutions[i].postures.size());
    else
      summary.unreached.push_back(static_cast<int>(i));
  }
  return summary;
}

}  // namespace kinfer
