// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/sweep/read_runs.hpp"

#include <nlohmann/json.hpp>
#include <set>

#include "kinfer/io/fleet/fleet_json.hpp"
#include "kinfer/io/fleet/manifest.hpp"
#include "kinfer/io/text/text_file.hpp"

namespace kinfer::cli {
namespace {

namespace fs = std::filesystem;

/// What task.json says; the sentence of what is wrong with it.
Result<void> read_task_record(const fs::path& folder, FleetRow& row) {
  KINFER_TRY(text, read_text_file(folder / "task.json"));
  const auto json = nlohmann::json::parse(text, nullptr, false);
  const auto has = [&](const char* key, auto is_kind) { return json.contains(key) && is_kind(json[key]); };
  const auto is_text = [](const nlohmann::json& value) { return value.is_string(); };
  const auto is_whole = [](const nlohmann::json& value) { return value.is_number_integer(); };
  if (!json.is_object() || !has("format", is_text) || json["format"] != "kinfer-task/1" || !has("verb", is_text) ||
      !has("exit_code", is_whole))
    return error("task.json: no record of a task");
  row.verb = json["verb"].get<std::string>();
  row.exit_code = json["exit_code"].get<int>();
  if (has("signal", is_whole)) row.signal = json["signal"].get<int>();
  if (has("sentence", is_text)) row.sentence = json["sentence"].get<std::string>();
  if (has("processor_class", is_text)) row.processor_class = json["processor_class"].get<std::string>();
  return {};
}

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

FleetRow read_row(const fs::path& folder, const std::string& key) {
  FleetRow row{.key = key, .folder = folder.string()};
  if (auto done = read_task_record(folder, row); !done) return make_unreadable(row, done.error()), row;
  if (!fs::exists(folder / "summary.json")) return row;  // a verb that has none, or one that failed before its end
  const auto text = read_text_file(folder / "summary.json");
  Result<TaskSummary> summary = text ? parse_task_summary(*text) : forward_error(text.error());
  if (!summary) return make_unreadable(row, summary.error()), row;
  row.summary = std::move(*summary);
  return row;
}

/// Folders of results without a row in the manifest; what begins with a point belongs to the sweep.
std::vector<std::string> unlisted_keys(const fs::path& path, const std::set<std::string>& listed) {
  std::set<std::string> keys;
  for (const fs::directory_entry& entry : fs::directory_iterator(path))
    if (const std::string name = entry.path().filename().string();
        name.front() != '.' && !listed.contains(name) && entry.is_directory())
      keys.insert(name);
  return {keys.begin(), keys.end()};
}

}  // namespace

Result<std::vector<FleetRow>> read_runs(const std::vector<std::string>& folders) {
  std::vector<FleetRow> rows;
  for (const std::string& folder : folders) {
    const fs::path path(folder);
    KINFER_TRY(tasks, read_manifest(path / "manifest.csv"));
    std::set<std::string> listed;
    for (const SweepTask& task : tasks) {
      listed.insert(task.key);
      FleetRow row{.key = task.key, .verb = task.verb, .state = TaskState::unfinished};
      if (fs::is_directory(path / task.key)) row = read_row(path / task.key, task.key);
      row.robot = task.robot, row.date = task.date;
      rows.push_back(std::move(row));
    }
    for (const std::string& key : unlisted_keys(path, listed)) rows.push_back(read_row(path / key, key));
  }
  std::set<std::string> keys;
  for (const FleetRow& row : rows)
    if (!keys.insert(row.key).second) return error("the key \"{}\" has results in two of the folders", row.key);
  return rows;
}

void read_information(std::vector<FleetRow>& rows, const std::vector<int>& which) {
  for (const int i : which) {
    FleetRow& row = rows[static_cast<std::size_t>(i)];
    const fs::path file = fs::path(row.folder) / "information.json";
    if (!fs::exists(file)) continue;  // a calibration that frees no joint parameter
    const auto text = read_text_file(file);
    Result<ParameterInformation> information = text ? parse_information(*text) : forward_error(text.error());
    if (information)
      row.summary.information = std::move(*information);
    else
      make_unreadable(row, information.error());
  }
}

}  // namespace kinfer::cli
