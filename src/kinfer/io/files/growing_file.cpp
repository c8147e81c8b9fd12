// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/files/growing_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

namespace kinfer {
namespace {

constexpr std::size_t most_head = 4096;  // [bytes] of a header and a row, whose time tells logs apart

}  // namespace

Result<GrowingFile> GrowingFile::open(const std::string& path) {
  const int file = path == "-" ? STDIN_FILENO : ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return error("{}: {}", path, std::strerror(errno));
  return GrowingFile(file, path == "-" ? "standard input" : path);
}

GrowingFile::~GrowingFile() {
  if (file_ > STDIN_FILENO) ::close(file_);
}

GrowingFile::GrowingFile(GrowingFile&& other) noexcept
    : file_(std::exchange(other.file_, -1)),
      offset_(other.offset_),
      name_(std::move(other.name_)),
      head_(std::move(other.head_)) {}

GrowingFile& GrowingFile::operator=(GrowingFile&& other) noexcept {
  std::swap(file_, other.file_), std::swap(name_, other.name_), std::swap(head_, other.head_);
  offset_ = other.offset_;
  return *this;
}

Result<std::string_view> GrowingFile::read() {
  const ssize_t count = ::read(file_, buffer_.data(), buffer_.size());
  if (count < 0 && errno != EINTR) return error("{}: reading stopped with an input error", name_);
  const std::string_view piece(buffer_.data(), count > 0 ? static_cast<std::size_t>(count) : 0);
  head_ += piece.substr(0, most_head - head_.size());
  offset_ += static_cast<off_t>(piece.size());
  return piece;
}

Rotation GrowingFile::rotation() const {
  struct stat open {
  }, named{};
  if (file_ == STDIN_FILENO || ::fstat(file_, &open) != 0) return Rotation::none;
  if (S_ISREG(open.st_mode) && (open.st_size < offset_ || !begins_as_read())) return Rotation::cut;
  if (::stat(name_.c_str(), &named) != 0) return Rotation::none;  // moved away, and not made anew yet
  return named.st_ino == open.st_ino && named.st_dev == open.st_dev ? Rotation::none : Rotation::replaced;
}

bool GrowingFile::begins_as_read() const {
  std::array<char, most_head> now;
  const ssize_t count = ::pread(file_, now.data(), head_.size(), 0);
  return count >= 0 && std::string_view(now.data(), static_cast<std::size_t>(count)) == head_;
}

}  // namespace kinfer
