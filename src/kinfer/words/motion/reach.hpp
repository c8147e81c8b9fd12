// SPDX-License-Identifier: Apache-2.0
// What came of reach targets, in words.
#pragma once

#include <string>
#include <vector>

#include "kinfer/evidence/motion/reach_solution.hpp"

namespace kinfer::words {

/// "58 of 60 targets are reached"
std::string summary(const ReachSummary& summary);

/// "target 3: out of reach; 412.0000 mm and 0.0000 deg are left"; targets are counted from 1.
std::string unreached_target(int target, const ReachSolution& solution, const std::vector<std::string>& joint_names);

}  // namespace kinfer::words
