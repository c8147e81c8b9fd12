// SPDX-License-Identifier: Apache-2.0
// Looks for parts of a page.
#pragma once

#include <string>

namespace kinfer::test {

inline bool shows(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

inline std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

}  // namespace kinfer::test
