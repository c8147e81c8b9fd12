// SPDX-License-Identifier: Apache-2.0
// Parts of a text replaced by others.
#pragma once

#include <string>
#include <string_view>

namespace kinfer {

/// Replaces every `what`, which is not empty, by `by`.
inline void replace_all(std::string& text, std::string_view what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
}

}  // namespace kinfer
