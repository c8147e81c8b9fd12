// SPDX-License-Identifier: Apache-2.0
// Completion scripts of shells: verbs, options, choices, and files where an option takes one.
#pragma once

#include "kinfer/cli/help/option_tree.hpp"

namespace kinfer::cli {

std::string bash_completion(const ProgramEntry& program);
std::string zsh_completion(const ProgramEntry& program);
std::string fish_completion(const ProgramEntry& program);

}  // namespace kinfer::cli
