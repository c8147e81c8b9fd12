// SPDX-License-Identifier: Apache-2.0
// Trimming of whitespace and quotes around cells.
#pragma once

#include <string_view>

namespace kinfer {

constexpr std::string_view whitespace = " \t\r";

/// `text` without leading and trailing characters of `outside`.
inline std::string_view trim(std::string_view text, std::string_view outside = whitespace) {
  const auto begin = text.find_first_not_of(outside);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(outside) - begin + 1);
}

/// The inside of a quoted cell, of a number without a delimiter in it; any other text as it is.
inline std::string_view without_quotes(std::string_view cell) {
  const bool is_quoted = cell.size() >= 2 && cell.front() == '"' && cell.back() == '"';
  return is_quoted ? trim(cell.substr(1, cell.size() - 2)) : cell;
}

}  // namespace kinfer
