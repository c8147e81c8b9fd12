// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/text/dump_json.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace kinfer {

std::string escape_controls(std::string json_text) {
  constexpr unsigned char del = 0x7F, lead = 0xC2;  // of U+0080 to U+00BF
  const auto is_suspect = [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte == del || byte == lead;
  };
  if (std::ranges::none_of(json_text, is_suspect)) return json_text;
  std::string escaped;
  for (std::size_t i = 0; i < json_text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(json_text[i]);
    const auto next = i + 1 < json_text.size() ? static_cast<unsigned char>(json_text[i + 1]) : 0U;
    const bool is_pair = byte == lead && next >= 0x80 && next < 0xA0;
    if (byte == del || is_pair)
      escaped += fmt::format("\\u{:04x}", is_pair ? next : byte);
    else
      escaped += json_text[i];
    i += is_pair ? 1 : 0;
  }
  return escaped;
}

}  // namespace kinfer
