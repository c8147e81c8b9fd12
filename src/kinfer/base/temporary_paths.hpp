// SPDX-License-Identifier: Apache-2.0
// Files and folders that must not outlive an interrupted program: results that are not complete yet.
#pragma once

#include <filesystem>
#include <string>

namespace kinfer {

/// While it lives, `remove_temporary_paths` removes this path. It removes nothing itself.
class TemporaryPath {
 public:
  explicit TemporaryPath(const std::filesystem::path& path);
  ~TemporaryPath();
  TemporaryPath(TemporaryPath&& other) noexcept;
  TemporaryPath& operator=(TemporaryPath&&) = delete;

 private:
  std::string path_;
  int slot_ = -1;  ///< −1: none was free, so the path is left behind
};

/// Unlinks the files and removes the folders, the latest first. Only calls what a signal handler may.
void remove_temporary_paths() noexcept;

}  // namespace kinfer
