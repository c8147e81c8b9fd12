// SPDX-License-Identifier: Apache-2.0
// A file, or standard input, that is read while somebody else writes it.
#pragma once

#include <sys/types.h>

#include <string>
#include <string_view>
#include <vector>

#include "kinfer/base/result.hpp"

namespace kinfer {

/// What log rotation has done to a file.
enum class Rotation {
  none,
  cut,      ///< it begins anew; what is read from where the reading stood may be in the middle of a row
  replaced  ///< another one stands in its place
};

class GrowingFile {
 public:
  /// `path`: "-" for standard input.
  static Result<GrowingFile> open(const std::string& path);
  ~GrowingFile();
  GrowingFile(GrowingFile&& other) noexcept;
  GrowingFile& operator=(GrowingFile&& other) noexcept;

  /// What has arrived, at least one byte unless the end is reached; waits for standard input. Valid until the next
  /// call. Errors: an input error of the device.
  Result<std::string_view> read();

  /// Since it was opened. A cut is known by the size, and by the first bytes where as much was written again.
  Rotation rotation() const;

 private:
  GrowingFile(int file, std::string name) : file_(file), name_(std::move(name)) {}
  bool begins_as_read() const;

  int file_;
  off_t offset_ = 0;  // [bytes] read
  std::string name_, head_;
  std::vector<char> buffer_ = std::vector<char>(1 << 16);
};

}  // namespace kinfer
