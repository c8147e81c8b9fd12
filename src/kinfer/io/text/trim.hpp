// SPDX-License-Identifier: Apache-2.0
// Trimming of whitespace around cells.
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

}  // namespace kinfer
