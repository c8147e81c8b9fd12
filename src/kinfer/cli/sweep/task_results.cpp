// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/sweep/task_results.hpp"

#include <algorithm>
#include <limits>
#include <vector>

#include "kinfer/cli/sweep/task_record.hpp"
#include "kinfer/io/files/text_file.hpp"
#include "kinfer/io/fleet/manifest.hpp"
#include "kinfer/io/fleet/task_pack.hpp"

namespace kinfer::cli {
namespace {

namespace fs = std::filesystem;

int exit_code_of(const TaskResults& results) {
  const auto text = read_task_file(results, "task.json");
  const auto record = text && *text ? parse_task_record(**text) : error("no record");
  return record ? record->exit_code : std::numeric_limits<int>::max();
}

std::vector<fs::path> archives_in(const fs::path& folder) {
  std::vector<fs::path> archives;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == archive_end && entry.path().filename().string().starts_with(archive_begin))
      archives.push_back(entry.path());
  std::ranges::sort(archives);
  return archives;
}

}  // namespace

Result<std::optional<std::string>> read_task_file(const TaskResults& results, const std::string& name) {
  if (results.packed_at) return read_packed_file(results.path, *results.packed_at, name);
  if (!fs::exists(results.path / name)) return std::optional<std::string>();
  KINFER_TRY(text, read_text_file(results.path / name));
  return std::optional(std::move(text));
}

Result<std::map<std::string, TaskResults>> packed_results(const fs::path& folder) {
  std::map<std::string, TaskResults> all;
  for (const fs::path& archive : archives_in(folder)) {
    KINFER_TRY(tasks, packed_tasks(archive));
    for (const PackedTask& task : tasks) {
      const TaskResults here{archive, task.offset};
      const auto [at, is_new] = all.emplace(task.key, here);
      if (is_new) continue;
      if (at->second.path == archive || exit_code_of(here) < exit_code_of(at->second)) at->second = here;
    }
  }
  return all;
}

}  // namespace kinfer::cli
