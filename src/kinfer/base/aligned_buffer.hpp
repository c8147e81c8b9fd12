// Numbers that start at a cache line: a pack that straddles two lines costs two loads. They come with arbitrary values.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

namespace kinfer::batch {

template <class T>
class Buffer {
 public:
  Buffer() = default;
  explicit Buffer(std::size_t size) { reserve(size); }

  /// At least so many numbers; what was there may be lost.
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
