// SPDX-License-Identifier: Apache-2.0
// JSON as text, whatever the names in it are: bytes of a log that are no UTF-8 become U+FFFD, and the control
// characters that JSON would let through, U+007F to U+009F, which can command a terminal, are escaped.
#pragma once

#include <string>

namespace kinfer {

/// U+007F to U+009F as \u007f ... \u009f. They can only stand inside of strings, so the JSON says the same.
std::string escape_controls(std::string json_text);

template <class Json>
std::string dump_json(const Json& json, int indent = -1) {
  return escape_controls(json.dump(indent, ' ', false, Json::error_handler_t::replace));
}

}  // namespace kinfer
