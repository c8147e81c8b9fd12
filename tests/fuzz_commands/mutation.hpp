// SPDX-License-Identifier: Apache-2.0
// Values that options and files should not have.
#pragma once

#include <string>

#include "fuzz_commands/option_tree.hpp"
#include "kinfer/base/rng.hpp"

namespace kinfer::fuzz {

/// A value for the option: usual, at a limit, absurd, of another type, or an input file.
std::string draw_value(const FuzzedOption& option, Rng& rng);

/// The text with some bytes, numbers, words, lines or columns changed.
std::string mutate(std::string text, Rng& rng);

}  // namespace kinfer::fuzz
