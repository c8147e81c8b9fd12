// SPDX-License-Identifier: Apache-2.0
// One run of the fuzzer: a command with its own copies of the inputs, some of them changed.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fuzz_commands/option_tree.hpp"
#include "kinfer/base/rng.hpp"

namespace kinfer::fuzz {

struct FuzzedCommand {
  std::vector<std::string> words;
  std::string changed;  ///< contents of the files that were changed
};

/// Draws a command and puts its inputs into `folder`, which is empty.
FuzzedCommand draw_command(const std::vector<FuzzedVerb>& verbs, const std::filesystem::path& material,
                           const std::filesystem::path& folder, Rng& rng);

}  // namespace kinfer::fuzz
