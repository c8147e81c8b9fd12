// SPDX-License-Identifier: Apache-2.0
// The topics of a robot log, and what each could be used for.
#pragma once

#include <string>

namespace kinfer::cli {

bool is_robot_log(const std::string& file);

/// Prints a table; an exit code.
int print_topics(const std::string& file);

}  // namespace kinfer::cli
