// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot/xml/xml_errors.hpp"

#include <cctype>

namespace kinfer {
namespace {

/// "XML_ERROR_MISMATCHED_ELEMENT" -> "mismatched element"
std::string readable_error_name(std::string name) {
  const std::string prefix = "XML_ERROR_";
  if (name.rfind(prefix, 0) == 0) name.erase(0, prefix.size());
  if (name == "PARSING") return "an element does not end";
  if (name == "XML_ELEMENT_DEPTH_EXCEEDED" || name == "ELEMENT_DEPTH_EXCEEDED")
    return "more than 100 elements inside each other";
  for (char& c : name) c = c == '_' ? ' ' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return name;
}

}  // namespace

tl::unexpected<Error> malformed_xml(const tinyxml2::XMLDocument& document, const std::string& name) {
  return error("{}:{}: malformed XML ({})", name, document.ErrorLineNum(), readable_error_name(document.ErrorName()));
}

}  // namespace kinfer
