// SPDX-License-Identifier: Apache-2.0
// Which of the targets of reach and path are not reached, and by how much.
#pragma once

#include <string>
#include <vector>

#include "kinfer/evidence/motion/reach_solution.hpp"

namespace kinfer::cli {

/// On standard error, a line for each of the first dozen, then how many are reached.
void print_unreached_targets(const std::vector<ReachSolution>& solutions, const std::vector<std::string>& joint_names);

}  // namespace kinfer::cli
