// SPDX-License-Identifier: Apache-2.0
// The joint columns of a result: headers and units as in the user's own file.
#pragma once

#include <string>
#include <vector>

#include "kinfer/io/motion/reach_targets_csv.hpp"

namespace kinfer::cli {

/// The headers of the input's joint columns with their units; q1.. in SI where the input has none.
std::vector<JointColumn> joint_columns(const std::string& path, const std::vector<std::string>& names);

}  // namespace kinfer::cli
