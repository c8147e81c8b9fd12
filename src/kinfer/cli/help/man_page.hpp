// SPDX-License-Identifier: Apache-2.0
// Man pages in the language of groff_man(7), made of the options themselves.
#pragma once

#include "kinfer/cli/help/option_tree.hpp"

namespace kinfer::cli {

/// kinfer-VERB(1)
std::string man_page(const VerbEntry& verb, const std::string& version);

/// kinfer(1)
std::string man_page(const ProgramEntry& program, const std::string& version);

}  // namespace kinfer::cli
