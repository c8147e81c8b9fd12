// SPDX-License-Identifier: Apache-2.0
// Valid inputs of all kinds, small, made by the program itself.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fuzz_commands/process.hpp"

namespace kinfer::fuzz {

/// Makes the inputs in `folder`; the sentence of what went wrong, or nothing.
std::string make_material(const std::filesystem::path& program, const std::filesystem::path& folder,
                          const Limits& limits);

/// A valid command: words, of which those that name files of the material are copied before each run.
struct Recipe {
  std::string verb;
  std::vector<std::string> words;
  int weight = 1;  ///< how often it is drawn; expensive ones seldom
};
const std::vector<Recipe>& recipes();

/// Files of the material of the kind that a placeholder asks for ("CSV", "TOML").
std::vector<std::string> files_for(const std::string& placeholder);

}  // namespace kinfer::fuzz
