// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/text/mapped_file.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <utility>

namespace kinfer {

Result<MappedFile> MappedFile::open(const std::filesystem::path& path) {
  std::error_code failure;
  if (!std::filesystem::exists(path, failure)) return error("{}: no such file", path.string());
  if (std::filesystem::is_directory(path, failure)) return error("{}: expected a file, found a folder", path.string());
  const int file = ::open(path.c_str(), O_RDONLY);
  if (file < 0) return error("{}: the file cannot be read (permissions?)", path.string());
  struct stat status {};
  const bool regular = ::fstat(file, &status) == 0 && S_ISREG(status.st_mode);
  const auto size = static_cast<std::size_t>(regular ? status.st_size : 0);
  void* data = size > 0 ? ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file, 0) : MAP_FAILED;
  ::close(file);
  if (!regular) return error("{}: expected a regular file (a pipe cannot be read here)", path.string());
  if (size == 0) return error("{}: the file is empty", path.string());
  if (data == MAP_FAILED) return error("{}: the file cannot be mapped into memory", path.string());
  ::madvise(data, size, MADV_SEQUENTIAL);
  return MappedFile(static_cast<const char*>(data), size);
}

MappedFile::MappedFile(MappedFile&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)), size_(std::exchange(other.size_, 0)), released_(other.released_) {}

MappedFile& MappedFile::operator=(MappedFile&& other) noexcept {
  std::swap(data_, other.data_);
  std::swap(size_, other.size_);
  std::swap(released_, other.released_);
  return *this;
}

MappedFile::~MappedFile() {
  if (data_) ::munmap(const_cast<char*>(data_), size_);
}

void MappedFile::release_before(std::size_t offset) {
  constexpr std::size_t block = std::size_t{1} << 24;  // a multiple of every page size
  const std::size_t whole = offset / block * block;
  if (whole <= released_) return;
  ::madvise(const_cast<char*>(data_) + released_, whole - released_, MADV_DONTNEED);
  released_ = whole;
}

}  // namespace kinfer
