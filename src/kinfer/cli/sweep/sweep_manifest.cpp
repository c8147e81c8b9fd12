// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/sweep/sweep_manifest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <unordered_map>

#include "kinfer/io/files/text_file.hpp"

namespace kinfer::cli {
namespace {

namespace fs = std::filesystem;

using TasksByKey = std::unordered_map<std::string, const SweepTask*>;

TasksByKey by_key(const std::vector<SweepTask>& tasks) {
  TasksByKey map;
  for (const SweepTask& task : tasks) map.emplace(task.key, &task);
  return map;
}

/// Rows of the folder's manifest that are others in `tasks`; rows that were added or left out are no contradiction.
std::vector<std::string> changed_keys(const TasksByKey& was, const std::vector<SweepTask>& is) {
  std::vector<std::string> keys;
  for (const SweepTask& task : is) {
    const auto old = was.find(task.key);
    if (old != was.end() && !(*old->second == task)) keys.push_back(task.key);
  }
  return keys;
}

std::string list_of(const std::vector<std::string>& names) {
  constexpr std::size_t most = 8;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, names.size()); ++i) text += (i > 0 ? ", " : "") + names[i];
  return names.size() > most ? fmt::format("{} and {} more", text, names.size() - most) : text;
}

}  // namespace

Result<void> check_manifest(const fs::path& path, const std::vector<SweepTask>& tasks, bool may_resume) {
  const fs::path manifest = path / manifest_name;
  if (!fs::exists(manifest)) {
    const auto is_hidden = [](const fs::directory_entry& entry) { return entry.path().filename().string()[0] == '.'; };
    if (!std::all_of(fs::directory_iterator(path), fs::directory_iterator(), is_hidden))
      return error("{}: expected a new or empty folder, or that of a sweep", path.string());
    return {};
  }
  if (!may_resume) return error("{}: holds results of a sweep; --resume goes on with it", path.string());
  KINFER_TRY(was, read_manifest(manifest));
  const TasksByKey old = by_key(was);
  if (std::ranges::none_of(tasks, [&](const SweepTask& task) { return old.contains(task.key); }))
    return error("{}: belongs to another manifest, with none of these keys", path.string());
  if (const auto changed = changed_keys(old, tasks); !changed.empty())
    return error("{}: rows of the manifest have changed since: {}; give these other keys, or the sweep another folder",
                 path.string(), list_of(changed));
  return {};
}

Result<void> update_manifest(const fs::path& path, const std::vector<SweepTask>& tasks) {
  const fs::path file = path / manifest_name;
  std::vector<SweepTask> all = tasks;
  std::string present;
  if (fs::exists(file)) {
    KINFER_TRY(was, read_manifest(file));
    KINFER_TRY(text, read_text_file(file));
    present = std::move(text);
    const TasksByKey now = by_key(tasks);
    for (SweepTask& task : was)
      if (!now.contains(task.key)) all.push_back(std::move(task));
  }
  const std::string text = format_manifest(all);
  return text == present ? Result<void>() : write_text_file(file, text);
}

}  // namespace kinfer::cli
