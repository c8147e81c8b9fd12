// Blanks around the cells of a text.
#pragma once

#include <string_view>

namespace kinfer {

constexpr std::string_view blanks = " \t\r";

/// The text without the characters of `outside` at its ends.
inline std::string_view trimmed(std::string_view text, std::string_view outside = blanks) {
  const auto begin = text.find_first_not_of(outside);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(outside) - begin + 1);
}

}  // namespace kinfer
