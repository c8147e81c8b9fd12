// SPDX-License-Identifier: Apache-2.0
// What `kinfer VERB --help` and `kinfer --help` print: options in groups, with defaults, and an example.
#pragma once

#include "kinfer/cli/help/option_tree.hpp"

namespace kinfer::cli {

/// `width`: columns of the terminal.
std::string help_text(const VerbEntry& verb, std::size_t width);
std::string help_text(const ProgramEntry& program, std::size_t width);

/// "-o, --out CSV", "--method lm|pso", "logs CSV..."
std::string option_usage(const OptionEntry& option);

/// "  kinfer calibrate --robot FILE --data CSV --out DIR [OPTIONS]"
std::string usage_line(const VerbEntry& verb);

/// The groups of the options, in the order in which they are listed.
std::vector<std::string> groups_of(const VerbEntry& verb);

}  // namespace kinfer::cli
