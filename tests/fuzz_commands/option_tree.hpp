// SPDX-License-Identifier: Apache-2.0
// The verbs and options of the program under test, as its own man pages state them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace kinfer::fuzz {

struct FuzzedOption {
  std::string name;                  ///< "--out"
  std::string placeholder;           ///< "CSV", "N"; empty: a flag
  std::vector<std::string> choices;  ///< the only values; empty: any
};

struct FuzzedVerb {
  std::string name;
  std::vector<FuzzedOption> options;  ///< without positional arguments, --help
};

/// `folder`: what `kinfer man --out folder` wrote.
std::vector<FuzzedVerb> read_option_tree(const std::filesystem::path& folder);

}  // namespace kinfer::fuzz
