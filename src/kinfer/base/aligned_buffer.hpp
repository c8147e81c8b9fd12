// SPDX-License-Identifier: Apache-2.0
// A buffer aligned to cache lines: a SIMD pack that straddles two lines costs two loads. Contents are uninitialised.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

namespace kinfer::batch {

template <class T>
class AlignedBuffer {
 public:
  AlignedBuffer() = default;
  explicit AlignedBuffer(std::size_t size) { reserve(size); }

  /// Makes room for at least `size` numbers; the contents may be lost.
  void reserve(std::size_t size) {
    if (size > size_) memory_.reset(new T[size + spare]), size_ = size;
  }

  T* data() { return memory_.get() + first(); }
  const T* data() const { return memory_.get() + first(); }
  std::size_t size() const { return size_; }

 private:
  static constexpr std::size_t line = 64, spare = line / sizeof(T);
  std::size_t first() const {
    const std::size_t past = reinterpret_cast<std::uintptr_t>(memory_.get()) % line;
    return past == 0 ? 0 : (line - past) / sizeof(T);
  }

  std::unique_ptr<T[]> memory_;
  std::size_t size_ = 0;
};

}  // namespace kinfer::batch
