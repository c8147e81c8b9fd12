// SPDX-License-Identifier: Apache-2.0
// The bytes of a large file, read a block ahead of the reader and dropped behind it, so that a recording whose text is
// larger than what is parsed needs little memory. A file that is cut meanwhile, as loggers do when they begin anew, is
// an error; one that is mapped would end the program by a signal.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "kinfer/base/result.hpp"

namespace kinfer {

/// Reads until `size` bytes are there or the file ends. Errors: an input error of the device.
Result<std::size_t> read_from(int file, char* to, std::size_t size, const std::string& name);

/// Owns its memory and the open file; movable. Missing files, empty files and pipes are errors.
class FileBytes {
 public:
  /// Its first block is read: 16 MiB.
  static Result<FileBytes> open(const std::filesystem::path& path);
  /// All of it.
  static Result<FileBytes> read(const std::filesystem::path& path);

  FileBytes(FileBytes&& other) noexcept;
  FileBytes& operator=(FileBytes&& other) noexcept;
  ~FileBytes();

  /// As long as the file was when it was opened; only the bytes that are filled and not released may be touched.
  std::string_view text() const { return {data_, size_}; }
  std::string_view filled() const { return {data_, filled_}; }

  /// Reads at least the bytes before `offset`, or all. Errors: an input error; the file has become shorter.
  Result<void> fill_to(std::size_t offset);
  /// The bytes before `offset` are not needed any more.
  void release_before(std::size_t offset);

 private:
  FileBytes(int file, char* data, std::size_t size, std::string name)
      : file_(file), data_(data), size_(size), name_(std::move(name)) {}

  int file_ = -1;
  char* data_ = nullptr;
  std::size_t size_ = 0, filled_ = 0, released_ = 0;
  std::string name_;
};

}  // namespace kinfer
