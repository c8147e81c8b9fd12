// SPDX-License-Identifier: Apache-2.0
// Where elements and attributes are in the bytes of an XML text.
//
// An XML library gives trees, and writes them with whitespace, quotes and entities of its own. To change one number of
// a file and nothing else, one needs its place in the text.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace kinfer {

struct XmlAttributePosition {
  std::string_view name;
  std::size_t name_begin = 0;
  std::size_t begin = 0, end = 0;  ///< of the value, without its quotes
  char quote = '"';
};

/// One element. Offsets are in bytes from the beginning of the text.
struct XmlElementPosition {
  std::string_view name;
  int parent = -1;            ///< index of the element around it; −1: none
  std::size_t begin = 0;      ///< of its "<"
  std::size_t name_end = 0;   ///< past its name
  std::size_t start_end = 0;  ///< past the ">" of its start tag
  bool is_empty = false;      ///< <name/>
  std::vector<XmlAttributePosition> attributes{};

  const XmlAttributePosition* attribute(std::string_view key) const;  ///< null where it has none
};

/// The elements in the order of the text; comments, CDATA, declarations and processing instructions are skipped. None
/// where start and end tags do not match, or a quote or bracket is not closed.
std::optional<std::vector<XmlElementPosition>> xml_positions(std::string_view text);

/// Name of the outermost element, "robot", as a part of the text; empty where the text does not begin with markup, or
/// holds no element.
std::string_view xml_root_name(std::string_view text);

}  // namespace kinfer
