// SPDX-License-Identifier: Apache-2.0
#include "kinfer/base/result.hpp"

#include <algorithm>

namespace kinfer {
namespace {

constexpr std::size_t longest_sentence = 2000, longest_word = 200, kept_of_word = 60;

/// The largest size up to `size` at which no UTF-8 character is divided.
std::size_t whole_characters(const std::string& text, std::size_t size) {
  while (size > 0 && size < text.size() && (static_cast<unsigned char>(text[size]) & 0xC0U) == 0x80U) --size;
  return size;
}

}  // namespace

std::string bounded_sentence(std::string text) {
  if (text.size() <= longest_sentence) return text;
  std::string result;
  for (std::size_t begin = 0; begin < text.size() && result.size() <= longest_sentence;) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    if (begin > 0) result += ' ';
    result += word.size() <= longest_word
                  ? word
                  : fmt::format("{}... ({} bytes)", word.substr(0, whole_characters(word, kept_of_word)), word.size());
    begin = end + 1;
  }
  if (result.size() > longest_sentence) result = result.substr(0, whole_characters(result, longest_sentence)) + "...";
  return result;
}

}  // namespace kinfer
