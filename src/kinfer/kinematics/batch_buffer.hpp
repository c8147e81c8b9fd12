// Numbers that start at a cache line: a pack that straddles two lines costs two loads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace kinfer::batch {

template <class T>
class Buffer {
 public:
  Buffer() = default;
  explicit Buffer(std::size_t size) { reserve(size); }

  /// At least so many numbers; what was there may be lost.
  void reserve(std::size_t size) {
    if (size > size_) memory_.assign(size + spare, T(0)), size_ = size;
  }

  T* data() { return memory_.data() + first(); }
  const T* data() const { return memory_.data() + first(); }
  std::size_t size() const { return size_; }

 private:
  static constexpr std::size_t line = 64, spare = line / sizeof(T);
  std::size_t first() const {
    const std::size_t past = reinterpret_cast<std::uintptr_t>(memory_.data()) % line;
    return past == 0 ? 0 : (line - past) / sizeof(T);
  }

  std::vector<T> memory_;
  std::size_t size_ = 0;
};

}  // namespace kinfer::batch
