// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot/patch/xml_edits.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "kinfer/io/text/format_number.hpp"

namespace kinfer {
namespace {

std::string quoted_attribute(std::string_view key, const std::string& value, char quote) {
  return fmt::format("{}={}{}{}", key, quote, value, quote);
}

/// The spaces before a position of the text, as far as they reach.
std::string_view space_before(std::string_view text, std::size_t at) {
  std::size_t begin = at;
  while (begin > 0 && std::string_view(" \t\r\n").find(text[begin - 1]) != std::string_view::npos) --begin;
  return text.substr(begin, at - begin);
}

}  // namespace

bool corresponds(std::string_view text, const XmlElementPosition& position, const tinyxml2::XMLElement& element) {
  std::size_t count = 0;
  for (const auto* attribute = element.FirstAttribute(); attribute; attribute = attribute->Next(), ++count) {
    const XmlAttributePosition* place = position.attribute(attribute->Name());
    if (!place) return false;
    const std::string_view bytes = text.substr(place->begin, place->end - place->begin);
    if (bytes.find_first_of("&\r\n\t") == std::string_view::npos && bytes != attribute->Value()) return false;
  }
  return count == position.attributes.size() && position.name == element.Name();
}

std::string plain_list(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : " ") + format_number(value + 0.0);
  return text;
}

void XmlEdits::set_attribute(const XmlElementPosition& element, std::string_view key, const std::string& value) {
  if (const XmlAttributePosition* place = element.attribute(key)) {
    edits_.push_back({place->begin, place->end - place->begin, value});
  } else if (element.attributes.empty()) {
    edits_.push_back({element.name_end, 0, " " + quoted_attribute(key, value, '"')});
  } else {  // after the last one, with the space that stands before it
    const XmlAttributePosition& last = element.attributes.back();
    edits_.push_back({last.end + 1, 0,
                      std::string(space_before(text_, last.name_begin)) + quoted_attribute(key, value, last.quote)});
  }
}

void XmlEdits::replace_attribute(const XmlElementPosition& element, std::string_view old_key, std::string_view key,
                                 const std::string& value) {
  const XmlAttributePosition* place = element.attribute(old_key);
  if (!place) return set_attribute(element, key, value);
  edits_.push_back({place->name_begin, old_key.size(), std::string(key)});
  edits_.push_back({place->begin, place->end - place->begin, value});
}

void XmlEdits::insert_before(const XmlElementPosition& neighbour, std::string_view name,
                             const std::vector<std::pair<std::string, std::string>>& attributes) {
  const char quote = neighbour.attributes.empty() ? '"' : neighbour.attributes.front().quote;
  const bool spaced_end = neighbour.is_empty && !space_before(text_, neighbour.start_end - 2).empty();
  std::string element = fmt::format("<{}", name);
  for (const auto& [key, value] : attributes) element += ' ' + quoted_attribute(key, value, quote);
  element += fmt::format("{}/>{}", spaced_end ? " " : "", space_before(text_, neighbour.begin));
  edits_.push_back({neighbour.begin, 0, std::move(element)});
}

std::string XmlEdits::apply() {
  std::ranges::stable_sort(edits_, {}, &Edit::at);
  std::string patched;
  std::size_t at = 0;
  for (const Edit& edit : edits_) {
    patched.append(text_, at, edit.at - at).append(edit.text);
    at = edit.at + edit.length;
  }
  return patched.append(text_, at);
}

}  // namespace kinfer
