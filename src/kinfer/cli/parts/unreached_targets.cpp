// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/parts/unreached_targets.hpp"

#include <algorithm>

#include "kinfer/cli/parts/terminal.hpp"
#include "kinfer/words/motion/reach.hpp"

namespace kinfer::cli {

void print_unreached_targets(const std::vector<ReachSolution>& solutions, const std::vector<std::string>& joint_names) {
  constexpr std::size_t most = 12;  // targets listed individually
  const ReachSummary summary = summarise(solutions);
  for (std::size_t i = 0; i < std::min(most, summary.unreached.size()); ++i) {
    const int target = summary.unreached[i];
    print_message("{}\n",
                  words::unreached_target(target + 1, solutions[static_cast<std::size_t>(target)], joint_names));
  }
  if (summary.unreached.size() > most) print_message("and {} more\n", summary.unreached.size() - most);
  print_message("{}\n", words::summary(summary));
}

}  // namespace kinfer::cli
