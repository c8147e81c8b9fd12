// SPDX-License-Identifier: Apache-2.0
// A list of parameter names as TOML: parameters = ["a2", "d4", "theta6"].
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kinfer/base/result.hpp"

namespace kinfer {

Result<std::vector<std::string>> read_parameter_names(const std::filesystem::path& path);

}  // namespace kinfer
