// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/text/quoted_text.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace kinfer {

std::size_t utf8_character_size(std::string_view text) {
  const auto lead = static_cast<unsigned char>(text.front());
  const std::size_t size = lead < 0x80                   ? 1
                           : lead >= 0xc2 && lead < 0xe0 ? 2
                           : lead >= 0xe0 && lead < 0xf0 ? 3
                           : lead >= 0xf0 && lead < 0xf5 ? 4
                                                         : 0;
  if (size == 0 || size > text.size()) return 0;
  for (std::size_t i = 1; i < size; ++i)
    if ((static_cast<unsigned char>(text[i]) & 0xc0) != 0x80) return 0;
  const auto second = size > 2 ? static_cast<unsigned char>(text[1]) : 0;
  const bool is_overlong = (lead == 0xe0 && second < 0xa0) || (lead == 0xf0 && second < 0x90);
  const bool is_surrogate = lead == 0xed && second >= 0xa0, is_beyond = lead == 0xf4 && second >= 0x90;
  const bool is_no_character = lead == 0xef && second == 0xbf && static_cast<unsigned char>(text[2]) >= 0xbe;
  return is_overlong || is_surrogate || is_beyond || is_no_character ? 0 : size;
}

std::string utf8_name(std::string_view name) {
  std::string text;
  while (!name.empty()) {
    const std::size_t size = utf8_character_size(name);
    text += size > 0 ? std::string(name.substr(0, size))
                     : fmt::format("_x{:04X}_", static_cast<unsigned char>(name.front()));
    name.remove_prefix(std::max<std::size_t>(size, 1));
  }
  return text;
}

std::string quoted_text(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : utf8_name(text)) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') quoted += '\\';
    if (byte < 0x20 || byte == 0x7f)
      quoted += fmt::format("\\u{:04X}", static_cast<unsigned>(byte));
    else
      quoted += c;
  }
  return quoted + '"';
}

}  // namespace kinfer
