// SPDX-License-Identifier: Apache-2.0
// A planned path in words.
#pragma once

#include <string>
#include <vector>

#include "kinfer/evidence/motion/timed_path.hpp"

namespace kinfer::words {

/// "4.312 s, 5 waypoints", or "2.107 s, 2 of 5 waypoints" where targets are not reached or the path ends before; with
/// what slows it down and how much corners are cut. `rotational`: of each joint; cuts in degrees or mm.
std::string summary(const PathResult& result, const std::vector<bool>& rotational);

/// "line 2, 1.240 s: J3 leaves its limits"; lines are counted from 1.
std::string sentence(const PathObstacle& obstacle, const std::vector<std::string>& joint_names);

}  // namespace kinfer::words
