// SPDX-License-Identifier: Apache-2.0
// A memory-mapped file, for recordings whose text is larger than the parsed data.
#pragma once

#include <filesystem>
#include <string_view>

#include "kinfer/base/result.hpp"

namespace kinfer {

/// Owns the mapping; movable. Missing files, empty files and files that cannot be mapped (pipes) are errors.
class MappedFile {
 public:
  static Result<MappedFile> open(const std::filesystem::path& path);
  MappedFile(MappedFile&& other) noexcept;
  MappedFile& operator=(MappedFile&& other) noexcept;
  ~MappedFile();

  std::string_view text() const { return {data_, size_}; }

  /// Tells the system that the bytes before `offset` will not be read again, so that it can drop their pages.
  void release_before(std::size_t offset);

 private:
  MappedFile(const char* data, std::size_t size) : data_(data), size_(size) {}
  const char* data_ = nullptr;
  std::size_t size_ = 0, released_ = 0;
};

}  // namespace kinfer
