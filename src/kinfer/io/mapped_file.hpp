// A file's bytes without a copy of them in memory, for recordings that are larger than what is made of them.
#pragma once

#include <filesystem>
#include <string_view>

#include "kinfer/base/result.hpp"

namespace kinfer {

/// Owns the mapping; movable. Files that cannot be mapped (pipes) are an error in words, as are missing and empty ones.
class MappedFile {
 public:
  static Result<MappedFile> open(const std::filesystem::path& path);
  MappedFile(MappedFile&& other) noexcept;
  MappedFile& operator=(MappedFile&& other) noexcept;
  ~MappedFile();

  std::string_view text() const { return {data_, size_}; }

  /// Tells the system that the bytes before `offset` will not be read again, so that they stop counting as memory.
  void forget_before(std::size_t offset);

 private:
  MappedFile(const char* data, std::size_t size) : data_(data), size_(size) {}
  const char* data_ = nullptr;
  std::size_t size_ = 0, forgotten_ = 0;
};

}  // namespace kinfer
