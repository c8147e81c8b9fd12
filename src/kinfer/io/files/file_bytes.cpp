// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/files/file_bytes.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

namespace kinfer {
namespace {

constexpr std::size_t block_size = std::size_t{1} << 24;  // a multiple of every page size

std::size_t whole_blocks(std::size_t size) {
  return (size + block_size - 1) / block_size * block_size;
}

}  // namespace

Result<std::size_t> read_from(int file, char* to, std::size_t size, const std::string& name) {
  std::size_t done = 0;
  while (done < size) {
    const ssize_t count = ::read(file, to + done, size - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return error("{}: reading stopped with an input error", name);
    if (count == 0) break;
    done += static_cast<std::size_t>(count);
  }
  return done;
}

Result<FileBytes> FileBytes::open(const std::filesystem::path& path) {
  const std::string name = path.string();
  std::error_code failure;
  if (!std::filesystem::exists(path, failure)) return error("{}: no such file", name);
  if (std::filesystem::is_directory(path, failure)) return error("{}: expected a file, found a folder", name);
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return error("{}: the file cannot be read (permissions?)", name);
  struct stat status {};
  const bool regular = ::fstat(file, &status) == 0 && S_ISREG(status.st_mode);
  const auto size = static_cast<std::size_t>(regular ? status.st_size : 0);
  // An address for each byte, and no memory yet.
  void* data = size > 0
                   ? ::mmap(nullptr, whole_blocks(size), PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0)
                   : MAP_FAILED;
  if (data == MAP_FAILED) ::close(file);
  if (!regular) return error("{}: expected a regular file (a pipe cannot be read here)", name);
  if (size == 0) return error("{}: the file is empty", name);
  if (data == MAP_FAILED) return error("{}: there is not enough memory for a file of {} bytes", name, size);
  FileBytes bytes(file, static_cast<char*>(data), size, name);
  if (auto done = bytes.fill_to(1); !done) return forward_error(done.error());
  return bytes;
}

Result<FileBytes> FileBytes::read(const std::filesystem::path& path) {
  KINFER_TRY(bytes, open(path));
  if (auto done = bytes.fill_to(bytes.size_); !done) return forward_error(done.error());
  return std::move(bytes);
}

Result<void> FileBytes::fill_to(std::size_t offset) {
  offset = std::min(offset, size_);
  while (filled_ < offset) {
    const std::size_t count = std::min(block_size, size_ - filled_);
    if (::mprotect(data_ + filled_, block_size, PROT_READ | PROT_WRITE) != 0)
      return error("{}: there is not enough memory to read on", name_);
    KINFER_TRY(found, read_from(file_, data_ + filled_, count, name_));
    if (found < count) return error("{}: the file has become shorter while it was read", name_);
    filled_ += count;
  }
  return {};
}

void FileBytes::release_before(std::size_t offset) {
  const std::size_t whole = std::min(offset, filled_) / block_size * block_size;
  if (whole <= released_) return;
  const void* freed = ::mmap(data_ + released_, whole - released_, PROT_NONE,
                             MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE | MAP_FIXED, -1, 0);
  if (freed != MAP_FAILED) released_ = whole;  // else the memory stays, and no more
}

FileBytes::FileBytes(FileBytes&& other) noexcept
    : file_(std::exchange(other.file_, -1)),
      data_(std::exchange(other.data_, nullptr)),
      size_(std::exchange(other.size_, 0)),
      filled_(std::exchange(other.filled_, 0)),
      released_(std::exchange(other.released_, 0)),
      name_(std::move(other.name_)) {}

FileBytes& FileBytes::operator=(FileBytes&& other) noexcept {
  std::swap(file_, other.file_);
  std::swap(data_, other.data_);
  std::swap(size_, other.size_);
  std::swap(filled_, other.filled_);
  std::swap(released_, other.released_);
  std::swap(name_, other.name_);
  return *this;
}

FileBytes::~FileBytes() {
  if (file_ >= 0) ::close(file_);
  if (data_) ::munmap(data_, whole_blocks(size_));
}

}  // namespace kinfer
