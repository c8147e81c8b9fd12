// SPDX-License-Identifier: Apache-2.0
// Where the results of a sweep's tasks are: each in a folder of its own, or many in an archive (`--pack`).
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "kinfer/base/result.hpp"

namespace kinfer::cli {

struct TaskResults {
  std::filesystem::path path{};              ///< the task's folder, or an archive
  std::optional<std::uint64_t> packed_at{};  ///< where in the archive; nothing: a folder
};

/// The bytes of a file of the task; nothing where it has none of this name.
Result<std::optional<std::string>> read_task_file(const TaskResults& results, const std::string& name);

/// The task's results by key, of all archives (results*.tar) in the folder of a sweep. Of a key that is in an archive
/// twice, because it was tried again, the later; of one in two archives, which happens when the number of shards was
/// changed between, the one that ended better.
Result<std::map<std::string, TaskResults>> packed_results(const std::filesystem::path& folder);

}  // namespace kinfer::cli
