// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/text/xml_positions.hpp"

namespace kinfer {
namespace {

constexpr std::string_view xml_space = " \t\r\n";
constexpr std::string_view ends_of_name = " \t\r\n=/><'\"";

class XmlScanner {
 public:
  explicit XmlScanner(std::string_view text) : text_(text) {}

  std::optional<std::vector<XmlElementPosition>> scan() {
    while ((at_ = text_.find('<', at_)) != std::string_view::npos)
      if (!read_markup()) return std::nullopt;
    if (!open_.empty()) return std::nullopt;
    return std::move(elements_);
  }

  /// Up to the start tag of the first element.
  std::string_view scan_root_name() {
    while (elements_.empty() && (at_ = text_.find('<', at_)) != std::string_view::npos)
      if (!read_markup()) return {};
    return elements_.empty() ? std::string_view{} : elements_.front().name;
  }

 private:
  bool starts_with(std::string_view token) const { return text_.substr(at_).starts_with(token); }

  bool read_markup() {
    if (starts_with("<!--")) return skip_past(at_ + 4, "-->");
    if (starts_with("<![CDATA[")) return skip_past(at_ + 9, "]]>");
    if (starts_with("<?")) return skip_past(at_ + 2, "?>");
    if (starts_with("<!")) return skip_past(at_ + 2, ">");
    return starts_with("</") ? read_end_tag() : read_start_tag();
  }

  bool skip_past(std::size_t from, std::string_view token) {
    const std::size_t found = text_.find(token, from);
    at_ = found == std::string_view::npos ? found : found + token.size();
    return found != std::string_view::npos;
  }

  void skip_space() { at_ = std::min(text_.find_first_not_of(xml_space, at_), text_.size()); }

  std::string_view read_name() {
    const std::size_t end = std::min(text_.find_first_of(ends_of_name, at_), text_.size());
    const std::string_view name = text_.substr(at_, end - at_);
    at_ = end;
    return name;
  }

  bool read_end_tag() {
    at_ += 2;
    const std::string_view name = read_name();
    skip_space();
    if (!starts_with(">") || open_.empty() || elements_[open_.back()].name != name) return false;
    open_.pop_back();
    ++at_;
    return true;
  }

  bool read_start_tag() {
    XmlElementPosition element;
    element.begin = at_++;
    element.parent = open_.empty() ? -1 : open_.back();
    element.name = read_name();
    element.name_end = at_;
    if (element.name.empty() || !read_attributes(element)) return false;
    element.is_empty = starts_with("/>");
    at_ += element.is_empty ? 2 : 1;
    element.start_end = at_;
    if (!element.is_empty) open_.push_back(static_cast<int>(elements_.size()));
    elements_.push_back(std::move(element));
    return true;
  }

  /// Up to the ">" or "/>" of the start tag.
  bool read_attributes(XmlElementPosition& element) {
    for (skip_space(); !starts_with(">") && !starts_with("/>"); skip_space()) {
      XmlAttributePosition attribute;
      attribute.name_begin = at_;
      attribute.name = read_name();
      skip_space();
      if (attribute.name.empty() || !starts_with("=")) return false;
      ++at_;
      skip_space();
      if (!starts_with("\"") && !starts_with("'")) return false;
      attribute.quote = text_[at_];
      attribute.begin = at_ + 1;
      attribute.end = text_.find(attribute.quote, attribute.begin);
      if (attribute.end == std::string_view::npos) return false;
      at_ = attribute.end + 1;
      element.attributes.push_back(attribute);
    }
    return true;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::vector<int> open_;  ///< elements whose end tag has not come yet
  std::vector<XmlElementPosition> elements_;
};

}  // namespace

const XmlAttributePosition* XmlElementPosition::attribute(std::string_view key) const {
  for (const XmlAttributePosition& candidate : attributes)
    if (candidate.name == key) return &candidate;
  return nullptr;
}

std::optional<std::vector<XmlElementPosition>> xml_positions(std::string_view text) {
  return XmlScanner(text).scan();
}

std::string_view xml_root_name(std::string_view text) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  const std::size_t first = text.find_first_not_of(xml_space, text.starts_with(byte_order_mark) ? 3 : 0);
  if (first == std::string_view::npos || text[first] != '<') return {};
  return XmlScanner(text).scan_root_name();
}

}  // namespace kinfer
