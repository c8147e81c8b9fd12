// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/sweep/read_runs.hpp"

#include <map>
#include <optional>
#include <set>

#include "kinfer/cli/sweep/task_record.hpp"
#include "kinfer/cli/sweep/task_results.hpp"
#include "kinfer/io/fleet/fleet_json.hpp"
#include "kinfer/io/fleet/manifest.hpp"

namespace kinfer::cli {
namespace {

namespace fs = std::filesystem;

/// Paths in a sentence would tell one sweep's folders from another's.
std::string without_folder(std::string text, const fs::path& folder) {
  const std::string path = folder.string() + "/";
  for (std::size_t at = text.find(path); at != std::string::npos; at = text.find(path, at)) text.erase(at, path.size());
  return text;
}

void make_unreadable(FleetRow& row, const Error& problem) {
  row.state = TaskState::unreadable;
  row.sentence = without_folder(problem.what, row.folder);
  row.summary = {};
}

Result<void> read_task_record(const TaskResults& results, FleetRow& row) {
  KINFER_TRY(text, read_task_file(results, "task.json"));
  if (!text) return error("{}: no such file", (results.path / "task.json").string());
  KINFER_TRY(record, parse_task_record(*text));
  row.verb = record.verb, row.exit_code = record.exit_code, row.signal = record.signal;
  row.sentence = record.sentence, row.processor_class = record.processor_class;
  return {};
}

FleetRow read_row(const TaskResults& results, const std::string& key) {
  FleetRow row{.key = key, .folder = results.path.string(), .packed_at = results.packed_at};
  if (auto done = read_task_record(results, row); !done) return make_unreadable(row, done.error()), row;
  const auto text = read_task_file(results, "summary.json");
  if (text && !*text) return row;  // a verb that has none, or one that failed before its end
  Result<TaskSummary> summary = text ? parse_task_summary(**text) : forward_error(text.error());
  if (!summary) return make_unreadable(row, summary.error()), row;
  row.summary = std::move(*summary);
  return row;
}

/// Folders of results without a row in the manifest; what begins with a point belongs to the sweep.
std::vector<std::string> unlisted_keys(const fs::path& path, const std::map<std::string, TaskResults>& packed,
                                       const std::set<std::string>& listed) {
  std::set<std::string> keys;
  for (const auto& [key, results] : packed)
    if (!listed.contains(key)) keys.insert(key);
  for (const fs::directory_entry& entry : fs::directory_iterator(path))
    if (const std::string name = entry.path().filename().string();
        name.front() != '.' && !listed.contains(name) && entry.is_directory())
      keys.insert(name);
  return {keys.begin(), keys.end()};
}

/// Shards in folders of their own list the tasks of all: those of the others are unfinished there.
Result<std::vector<FleetRow>> one_row_a_key(std::vector<FleetRow> rows) {
  std::map<std::string, std::size_t> index;
  std::vector<FleetRow> merged;
  for (FleetRow& row : rows) {
    const auto [at, is_new] = index.emplace(row.key, merged.size());
    if (is_new) {
      merged.push_back(std::move(row));
      continue;
    }
    FleetRow& present = merged[at->second];
    if (row.state == TaskState::unfinished) continue;
    if (present.state != TaskState::unfinished)
      return error("the key \"{}\" has results in two of the folders", row.key);
    present = std::move(row);
  }
  return merged;
}

}  // namespace

Result<std::vector<FleetRow>> read_runs(const std::vector<std::string>& folders) {
  std::vector<FleetRow> rows;
  for (const std::string& folder : folders) {
    const fs::path path(folder);
    KINFER_TRY(tasks, read_manifest(path / manifest_name));
    KINFER_TRY(packed, packed_results(path));
    const auto results_of = [&](const std::string& key) -> std::optional<TaskResults> {
      if (fs::is_directory(path / key)) return TaskResults{path / key, {}};
      const auto found = packed.find(key);
      return found == packed.end() ? std::nullopt : std::optional(found->second);
    };
    std::set<std::string> listed;
    for (const SweepTask& task : tasks) {
      listed.insert(task.key);
      FleetRow row{.key = task.key, .verb = task.verb, .state = TaskState::unfinished};
      if (const auto results = results_of(task.key)) row = read_row(*results, task.key);
      row.robot = task.robot, row.date = task.date;
      rows.push_back(std::move(row));
    }
    for (const std::string& key : unlisted_keys(path, packed, listed)) rows.push_back(read_row(*results_of(key), key));
  }
  return one_row_a_key(std::move(rows));
}

void read_information(std::vector<FleetRow>& rows, const std::vector<int>& which) {
  for (const int i : which) {
    FleetRow& row = rows[static_cast<std::size_t>(i)];
    const auto text = read_task_file({row.folder, row.packed_at}, "information.json");
    if (text && !*text) continue;  // a calibration that frees no joint parameter
    Result<ParameterInformation> information = text ? parse_information(**text) : forward_error(text.error());
    if (information)
      row.summary.information = std::move(*information);
    else
      make_unreadable(row, information.error());
  }
}

}  // namespace kinfer::cli
