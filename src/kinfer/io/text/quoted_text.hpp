// SPDX-License-Identifier: Apache-2.0
// Any text as a string between quotes that TOML and YAML read back.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace kinfer {

/// Number of bytes of the UTF-8 character at the beginning; 0 where there is none.
std::size_t utf8_character_size(std::string_view text);

/// Bytes that are no UTF-8 are written as _xHHHH_ and stay so on reading.
std::string utf8_name(std::string_view name);

/// A basic string of TOML (toml.io, v1.0.0), which is a double-quoted one of YAML too: quotes, backslashes and control
/// characters are escaped, bytes that are no UTF-8 as in utf8_name.
std::string quoted_text(std::string_view text);

}  // namespace kinfer
