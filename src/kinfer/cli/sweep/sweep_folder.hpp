// SPDX-License-Identifier: Apache-2.0
// The folder of a sweep: its manifest, one folder for each task that has ended, and those of tasks that run under names
// that begin with a point. A task's folder is renamed when it is complete: what exists is done.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/io/fleet/manifest.hpp"

namespace kinfer::cli {

/// Part i of N of the tasks, i from 1.
struct Shard {
  int part = 1, parts = 1;
  bool has(std::size_t task) const { return static_cast<int>(task % static_cast<std::size_t>(parts)) == part - 1; }
};
Result<Shard> parse_shard(const std::string& text);

struct TaskResult {
  int exit_code = 0;
  int signal = 0;
  std::string sentence{};  ///< what the program said where it failed; empty: nothing
};

class SweepFolder {
 public:
  /// Locks the folder (each shard its part) until this process ends. Errors: it holds results and `may_resume` is
  /// false; rows of its manifest differ from `tasks`; another process works on it.
  static Result<SweepFolder> open(const std::filesystem::path& path, const std::vector<SweepTask>& tasks,
                                  const Shard& shard, bool may_resume);
  ~SweepFolder();
  SweepFolder(SweepFolder&& other) noexcept;
  SweepFolder& operator=(SweepFolder&&) = delete;

  bool is_done(const SweepTask& task) const;
  /// The result of a task that has ended.
  Result<TaskResult> result_of(const SweepTask& task) const;

  /// An empty folder for a task that begins.
  Result<std::filesystem::path> begin(const SweepTask& task) const;
  /// Writes task.json and renames the folder; one that exists already stays as it is.
  Result<TaskResult> end(const SweepTask& task, std::uint64_t seed, int exit_code, int signal) const;
  /// Takes a result away, so that the task is run again.
  void discard(const SweepTask& task) const;

 private:
  SweepFolder(std::filesystem::path path, int lock) : path_(std::move(path)), lock_(lock) {}
  std::filesystem::path path_;
  int lock_ = -1;
};

}  // namespace kinfer::cli
