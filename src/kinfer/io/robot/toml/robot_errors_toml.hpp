// SPDX-License-Identifier: Apache-2.0
// Parameter errors of a robot, for simulation: units = { length = "mm", angle = "deg" }, [errors] a2 = 0.05.
#pragma once

#include <filesystem>

#include "kinfer/base/result.hpp"
#include "kinfer/io/robot/toml/robot_toml.hpp"

namespace kinfer {

/// The robot's chain with the file's errors added. An unknown parameter name is an error.
Result<Chain> read_robot_errors(const std::filesystem::path& path, const RobotModel& robot);

}  // namespace kinfer
