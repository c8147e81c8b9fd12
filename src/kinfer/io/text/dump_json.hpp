// SPDX-License-Identifier: Apache-2.0
// JSON as text, whatever the names in it are: bytes of a log that are no UTF-8 become U+FFFD.
#pragma once

#include <string>

namespace kinfer {

template <class Json>
std::string dump_json(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace kinfer
