// SPDX-License-Identifier: Apache-2.0
// The folder of a sweep: its manifest, one folder for each task that has ended, and those of tasks that run under names
// that begin with a point. A task's folder is renamed when it is complete: what exists is done. Where so many small
// files are too much for a file system, tasks run below the temporary folder, and each shard adds their files to one
// archive.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/cli/sweep/task_record.hpp"
#include "kinfer/cli/sweep/task_results.hpp"
#include "kinfer/io/fleet/manifest.hpp"
#include "kinfer/io/fleet/task_pack.hpp"

namespace kinfer::cli {

/// Part i of N of the tasks, i from 1.
struct Shard {
  int part = 1, parts = 1;
  bool has(std::size_t task) const { return static_cast<int>(task % static_cast<std::size_t>(parts)) == part - 1; }
};
Result<Shard> parse_shard(const std::string& text);

enum class ResultStorage { folders, archive };

class SweepFolder {
 public:
  /// Locks the folder (each shard its part) until this process ends. Errors: it holds results and `may_resume` is
  /// false; rows of its manifest differ from `tasks`; another process works on it.
  static Result<SweepFolder> open(const std::filesystem::path& path, const std::vector<SweepTask>& tasks,
                                  const Shard& shard, bool may_resume, ResultStorage storage);
  ~SweepFolder();
  SweepFolder(SweepFolder&& other) noexcept;
  SweepFolder& operator=(SweepFolder&&) = delete;

  bool is_done(const SweepTask& task) const;
  /// The result of a task that has ended.
  Result<TaskRecord> result_of(const SweepTask& task) const;

  /// An empty folder for a task that begins.
  Result<std::filesystem::path> begin(const SweepTask& task) const;
  /// Writes task.json and puts the folder in its place, or into the archive; what is done already stays as it is.
  Result<TaskRecord> end(const SweepTask& task, std::uint64_t seed, int exit_code, int signal);
  /// Takes a result away, so that the task is run again.
  void discard(const SweepTask& task);

 private:
  SweepFolder(std::filesystem::path path, int lock) : path_(std::move(path)), lock_(lock) {}
  Result<void> pack_results(const std::string& name);
  std::filesystem::path running(const SweepTask& task) const;
  Result<void> put_in_place(const SweepTask& task, const std::filesystem::path& folder) const;
  Result<void> put_into_pack(const SweepTask& task, const std::filesystem::path& folder);

  std::filesystem::path path_;
  int lock_ = -1;
  std::map<std::string, TaskResults> packed_{};
  std::optional<TaskPack> pack_{};
  std::filesystem::path scratch_{};  ///< where tasks run whose results go into the archive
};

}  // namespace kinfer::cli
