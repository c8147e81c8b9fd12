// SPDX-License-Identifier: Apache-2.0
// Little-endian numbers and blocks, taken from bytes one after the other. Past the end everything is zero or empty and
// the cursor is no longer good: a reader checks once, at the end of a record.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <string_view>

namespace kinfer {

class ByteCursor {
 public:
  explicit ByteCursor(std::string_view bytes) : bytes_(bytes) {}

  bool good() const { return good_; }
  std::size_t at() const { return at_; }
  std::size_t left() const { return bytes_.size() - at_; }

  std::string_view take(std::size_t size) {
    if (size > left()) {
      good_ = false;
      at_ = bytes_.size();
      return {};
    }
    const std::string_view block = bytes_.substr(at_, size);
    at_ += size;
    return block;
  }

  template <class T>
  T number() {
    const std::string_view raw = take(sizeof(T));
    if (raw.empty()) return T{};
    std::array<char, sizeof(T)> bytes;
    std::copy(raw.begin(), raw.end(), bytes.begin());
    if constexpr (std::endian::native == std::endian::big) std::reverse(bytes.begin(), bytes.end());
    return std::bit_cast<T>(bytes);
  }

  /// A block behind its length, of type Length.
  template <class Length>
  std::string_view block() {
    return take(static_cast<std::size_t>(number<Length>()));
  }

  /// Skips to the next multiple of `size`, counted from the start of the bytes.
  void align(std::size_t size) { take((size - at_ % size) % size); }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
  bool good_ = true;
};

}  // namespace kinfer
