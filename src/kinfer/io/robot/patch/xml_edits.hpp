// SPDX-License-Identifier: Apache-2.0
// Changes of single attributes in the bytes of an XML text; every other byte stays.
#pragma once

#include <tinyxml2.h>

#include <string>
#include <string_view>
#include <vector>

#include "kinfer/evidence/calibration/model_patch.hpp"
#include "kinfer/io/text/xml_positions.hpp"

namespace kinfer {

/// Does the element found in the text have the name and the attributes of the one that tinyxml2 read? Values are
/// compared where they hold no entity and no line end, which tinyxml2 decodes.
bool corresponds(std::string_view text, const XmlElementPosition& position, const tinyxml2::XMLElement& element);

/// "0 0 0.5": numbers that read back to the same bits, 0 for -0, which is how people write it.
std::string plain_list(const std::vector<double>& values);
inline std::string plain_list(const Vec3& v) {
  return plain_list(std::vector<double>{v.x(), v.y(), v.z()});
}

struct PatchedText {
  std::string text;
  std::vector<OriginChange> changes;  ///< in the order of the file; joints that keep their origin are absent
};

class XmlEdits {
 public:
  /// `text` must outlive the edits.
  explicit XmlEdits(std::string_view text) : text_(text) {}

  /// Changes the value of an attribute, or adds it in the style of those beside it.
  void set_attribute(const XmlElementPosition& element, std::string_view key, const std::string& value);

  /// Puts another attribute in the place of `old_key`.
  void replace_attribute(const XmlElementPosition& element, std::string_view old_key, std::string_view key,
                         const std::string& value);

  /// An empty element before `neighbour`, with that one's indentation, quotes and way to end an empty element.
  void insert_before(const XmlElementPosition& neighbour, std::string_view name,
                     const std::vector<std::pair<std::string, std::string>>& attributes);

  std::string apply();

 private:
  struct Edit {  ///< replaces `length` bytes from `at`
    std::size_t at = 0, length = 0;
    std::string text;
  };

  std::string_view text_;
  std::vector<Edit> edits_;
};

}  // namespace kinfer
