// SPDX-License-Identifier: Apache-2.0
// The program as a function, for a verb that runs other verbs.
#pragma once

#include <string>
#include <vector>

namespace kinfer::cli {

/// Runs `kinfer arguments`; returns its exit code.
int run_program(const std::vector<std::string>& arguments);

/// Columns of the terminal that the text is printed to, 60 to 120; 100 where it is none.
std::size_t terminal_width();

}  // namespace kinfer::cli
