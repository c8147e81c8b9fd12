// SPDX-License-Identifier: Apache-2.0
// "Did you mean": the known word that a misspelt one is nearest to.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinfer/cli/help/option_tree.hpp"

namespace kinfer::cli {

/// Insertions, deletions, substitutions and swaps of neighbours that lead from one word to the other (Damerau 1964, as
/// optimal string alignment).
int edit_distance(std::string_view a, std::string_view b);

/// The nearest of the known words, if it is near: at most a third of its letters differ, or it begins with the word.
std::optional<std::string> nearest_word(std::string_view word, const std::vector<std::string>& known);

/// A sentence where the verb, or an option of it, is not known; none where all are. `arguments`: without the program.
std::optional<std::string> misspelling(const std::vector<std::string>& arguments, const ProgramEntry& program);

}  // namespace kinfer::cli
