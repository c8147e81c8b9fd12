// SPDX-License-Identifier: Apache-2.0
// The results of many tasks in one file, for file systems that many small files wear down: a tar archive that `tar xf`
// unpacks into one folder a task. Each task begins with a comment of the archive (pax) that states its key and how many
// bytes its files take: a reader jumps from task to task, and what a killed run left at the end is known to be partial.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "kinfer/base/result.hpp"

namespace kinfer {

struct PackedTask {
  std::string key{};
  std::uint64_t offset = 0, size = 0;  ///< [bytes] in the archive
};

/// The complete tasks, in the order in which they were written. Errors: the file cannot be read; what stands where a
/// task should begin is none.
Result<std::vector<PackedTask>> packed_tasks(const std::filesystem::path& pack);

/// The bytes of the file `name` of the task that begins at `offset`; nothing where the task has no such file.
Result<std::optional<std::string>> read_packed_file(const std::filesystem::path& pack, std::uint64_t offset,
                                                    const std::string& name);

/// An archive that takes further tasks; one process at a time.
class TaskPack {
 public:
  /// Created where it is absent; a partial task at its end is cut off.
  static Result<TaskPack> open(const std::filesystem::path& path);
  ~TaskPack();
  TaskPack(TaskPack&& other) noexcept;
  TaskPack& operator=(TaskPack&&) = delete;

  const std::filesystem::path& path() const { return path_; }

  /// Adds the files of `folder` as those of a task, all or none; `first`: names that come first, so that they are read
  /// without a search. Returns where the task begins.
  Result<std::uint64_t> append(const std::string& key, const std::filesystem::path& folder,
                               const std::vector<std::string>& first);

 private:
  TaskPack(std::filesystem::path path, int file) : path_(std::move(path)), file_(file) {}
  std::filesystem::path path_;
  int file_ = -1;
};

}  // namespace kinfer
