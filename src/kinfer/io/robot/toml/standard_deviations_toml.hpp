// SPDX-License-Identifier: Apache-2.0
// The standard deviations that a chain.toml stores beside the numbers of its joints (a_sd, theta_sd, xyz_sd, ...).
#pragma once

#include <filesystem>

#include "kinfer/io/robot/toml/robot_toml.hpp"

namespace kinfer {

/// By parameter name, SI: "a2", "theta3", "x4", "rx4". Parameters without a standard deviation are absent.
Result<StandardDeviations> read_standard_deviations(const std::filesystem::path& path);

}  // namespace kinfer
