// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot/xml_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace kinfer {
namespace {

constexpr std::size_t escape_size = 7;  // "_xHHHH_"

/// Number of bytes of the UTF-8 character at the beginning; 0 where there is none.
std::size_t character_size(std::string_view text) {
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

/// Value of an escape at the beginning of the text; −1 where there is none.
int escaped_value(std::string_view text) {
  if (text.size() < escape_size || !text.starts_with("_x") || text[escape_size - 1] != '_') return -1;
  int value = 0;
  const auto [end, code] = std::from_chars(text.data() + 2, text.data() + escape_size - 1, value, 16);
  return code == std::errc{} && end == text.data() + escape_size - 1 ? value : -1;
}

/// What xml_name escapes: control characters, bytes that are no UTF-8, and the underscore of what looks like an escape.
bool is_escaped(int value) {
  return (value >= 0 && value < 0x20) || (value >= 0x7f && value <= 0xff) || value == '_';
}

}  // namespace

std::string xml_name(std::string_view name) {
  std::string text;
  while (!name.empty()) {
    const auto byte = static_cast<unsigned char>(name.front());
    const std::size_t size = character_size(name);
    const bool looks_like_escape = is_escaped(escaped_value(name));
    if (size == 0 || byte < 0x20 || byte == 0x7f || looks_like_escape) {
      text += fmt::format("_x{:04X}_", byte);
      name.remove_prefix(1);
    } else {
      text += name.substr(0, size);
      name.remove_prefix(size);
    }
  }
  return text;
}

std::string utf8_name(std::string_view name) {
  std::string text;
  while (!name.empty()) {
    const std::size_t size = character_size(name);
    text += size > 0 ? std::string(name.substr(0, size))
                     : fmt::format("_x{:04X}_", static_cast<unsigned char>(name.front()));
    name.remove_prefix(std::max<std::size_t>(size, 1));
  }
  return text;
}

std::string name_from_xml(std::string_view text) {
  std::string name;
  while (!text.empty()) {
    const int value = escaped_value(text);
    const bool is_escape = is_escaped(value);
    name += is_escape ? static_cast<char>(value) : text.front();
    text.remove_prefix(is_escape ? escape_size : 1);
  }
  return name;
}

Chain with_xml_names(Chain chain) {
  chain.name = xml_name(chain.name);
  for (Joint& joint : chain.joints) joint.name = xml_name(joint.name);
  for (LoopClosure& closure : chain.closures) closure.name = xml_name(closure.name);
  for (Target& target : chain.targets) target.name = xml_name(target.name);
  return chain;
}

}  // namespace kinfer
