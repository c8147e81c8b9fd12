// SPDX-License-Identifier: Apache-2.0
// What kinfer promises of every run, whatever its options and files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fuzz_commands/process.hpp"

namespace kinfer::fuzz {

/// The broken promises of one run; empty: none. `words` and `inputs` are what the user gave: the program may quote it.
std::vector<std::string> broken_promises(const ProcessResult& run, const std::vector<std::string>& words,
                                         const std::string& inputs, const std::filesystem::path& folder);

}  // namespace kinfer::fuzz
