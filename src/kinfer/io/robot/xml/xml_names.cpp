// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot/xml/xml_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "kinfer/io/text/quoted_text.hpp"

namespace kinfer {
namespace {

constexpr std::size_t escape_size = 7;  // "_xHHHH_"

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
    const std::size_t size = utf8_character_size(name);
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

std::string unique_name(const std::string& wish, std::set<std::string>& taken) {
  std::string name = wish;
  for (int i = 2; !taken.insert(name).second; ++i) name = fmt::format("{}_{}", wish, i);
  return name;
}

}  // namespace kinfer
