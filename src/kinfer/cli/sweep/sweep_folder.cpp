// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/sweep/sweep_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>
#include <unordered_map>
#include <utility>

#include "kinfer/base/instruction_set.hpp"
#include "kinfer/io/text/dump_json.hpp"
#include "kinfer/io/text/replace_all.hpp"
#include "kinfer/io/text/text_file.hpp"

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

Result<void> check_manifest(const fs::path& path, const std::vector<SweepTask>& tasks, bool may_resume) {
  const fs::path manifest = path / "manifest.csv";
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

/// Folders of this shard's tasks that were running when an earlier process was killed.
void remove_unfinished(const fs::path& path, const std::vector<SweepTask>& tasks, const Shard& shard) {
  std::set<std::string> keys;
  for (std::size_t i = 0; i < tasks.size(); ++i)
    if (shard.has(i)) keys.insert(tasks[i].key);
  std::vector<fs::path> unfinished;
  for (const fs::directory_entry& entry : fs::directory_iterator(path)) {
    const std::string name = entry.path().filename().string();  // ".KEY.PROCESS"
    const std::size_t point = name.rfind('.');
    const std::string owner = name.substr(1, point - 1);
    // Of a task, or what a task that was killed had not put in place.
    const bool is_staging = name.starts_with("..") && name.find(".kinfer-") != std::string::npos &&
                            keys.contains(owner.substr(1, owner.rfind('.') - 1));
    if (name.front() == '.' && point > 0 && entry.is_directory() && (keys.contains(owner) || is_staging))
      unfinished.push_back(entry.path());
  }
  std::error_code ignored;
  for (const fs::path& folder : unfinished) fs::remove_all(folder, ignored);
}

/// Tasks of a sweep that was killed hold its lock until they have died too, some milliseconds later, under load
/// seconds.
bool take_lock(int file) {
  constexpr int trials = 100;
  for (int i = 0; i < trials; ++i) {
    if (::flock(file, LOCK_EX | LOCK_NB) == 0) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return false;
}

/// While it lives, other shards that begin wait: they all look at the manifest, and write it, one after the other. A
/// file system without locks lets them pass.
class FolderTurn {
 public:
  explicit FolderTurn(const fs::path& folder) : folder_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    if (folder_ >= 0) ::flock(folder_, LOCK_EX);
  }
  ~FolderTurn() {
    if (folder_ >= 0) ::close(folder_);
  }
  FolderTurn(const FolderTurn&) = delete;
  FolderTurn& operator=(const FolderTurn&) = delete;

 private:
  int folder_;
};

/// With rows that an earlier manifest had and this one has not, so that their results stay explained.
Result<void> update_manifest(const fs::path& file, const std::vector<SweepTask>& tasks) {
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

/// Writes "{out}" for the folder under which the task ran: its name is of one run.
void hide_folder(const fs::path& file, const std::string& folder) {
  const auto text = read_text_file(file);
  if (!text) return;
  std::string plain = *text;
  replace_all(plain, folder, "{out}");
  if (plain != *text) std::ofstream(file, std::ios::binary) << plain;
}

/// The last line that the program printed as an error, without its name.
std::string last_complaint(const fs::path& messages) {
  std::ifstream file(messages);
  std::string found, line;
  while (std::getline(file, line))
    if (line.starts_with("kinfer: ")) found = line.substr(8);
  return found;
}

}  // namespace

Result<Shard> parse_shard(const std::string& text) {
  Shard shard;
  char rest = '\0';
  if (std::sscanf(text.c_str(), "%d/%d%c", &shard.part, &shard.parts, &rest) != 2)
    return error("--shard {}: expected a part and the number of parts, as 2/8", text);
  if (shard.parts < 1 || shard.part < 1 || shard.part > shard.parts)
    return error("--shard {}: expected a part from 1 to {}", text, std::max(1, shard.parts));
  return shard;
}

Result<SweepFolder> SweepFolder::open(const fs::path& path, const std::vector<SweepTask>& tasks, const Shard& shard,
                                      bool may_resume) {
  std::error_code failure;
  fs::create_directories(path, failure);
  const FolderTurn turn(path);
  if (auto ready = create_writable_folder(path); !ready) return forward_error(ready.error());
  if (auto checked = check_manifest(path, tasks, may_resume); !checked) return forward_error(checked.error());
  const std::string name = shard.parts == 1 ? ".lock" : fmt::format(".lock-{}-of-{}", shard.part, shard.parts);
  const int lock = ::open((path / name).c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  SweepFolder folder(path, lock);
  if (lock < 0) return error("{}: cannot be locked", path.string());
  if (!take_lock(lock)) return error("{}: another sweep works in this folder", path.string());
  remove_unfinished(path, tasks, shard);
  if (auto written = update_manifest(path / "manifest.csv", tasks); !written) return forward_error(written.error());
  return folder;
}

SweepFolder::SweepFolder(SweepFolder&& other) noexcept
    : path_(std::move(other.path_)), lock_(std::exchange(other.lock_, -1)) {}

SweepFolder::~SweepFolder() {
  if (lock_ >= 0) ::close(lock_);
}

bool SweepFolder::is_done(const SweepTask& task) const {
  return fs::exists(path_ / task.key);
}

Result<TaskResult> SweepFolder::result_of(const SweepTask& task) const {
  const fs::path file = path_ / task.key / "task.json";
  KINFER_TRY(text, read_text_file(file));
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains("exit_code") || !json["exit_code"].is_number_integer())
    return error("{}: no record of a task", file.string());
  return TaskResult{.exit_code = json["exit_code"].get<int>(),
                    .signal = json.value("signal", 0),
                    .sentence = json.value("sentence", std::string())};
}

Result<fs::path> SweepFolder::begin(const SweepTask& task) const {
  const fs::path folder = path_ / fmt::format(".{}.{}", task.key, ::getpid());
  std::error_code failure;
  fs::remove_all(folder, failure);
  if (!fs::create_directory(folder, failure)) return error("{}: the folder cannot be made", folder.string());
  return folder;
}

Result<TaskResult> SweepFolder::end(const SweepTask& task, std::uint64_t seed, int exit_code, int signal) const {
  const fs::path folder = path_ / fmt::format(".{}.{}", task.key, ::getpid());
  TaskResult result{.exit_code = exit_code, .signal = signal, .sentence = {}};
  if (signal != 0)
    result.sentence = fmt::format("the program was ended by signal {}", signal);
  else if (exit_code > 1)
    result.sentence = last_complaint(folder / "messages.txt");
  std::error_code ignored;
  for (const char* name : {"output.txt", "messages.txt"}) {
    hide_folder(folder / name, folder.string());
    if (fs::file_size(folder / name, ignored) == 0) fs::remove(folder / name, ignored);
  }
  nlohmann::ordered_json json{{"format", "kinfer-task/1"},
                              {"key", task.key},
                              {"verb", task.verb},
                              {"arguments", task.arguments},
                              {"seed", seed},
                              {"exit_code", exit_code},
                              {"signal", signal},
                              {"processor_class", processor_class()},
                              {"sentence", result.sentence}};
  if (auto done = write_text_file(folder / "task.json", dump_json(json, 1) + "\n"); !done)
    return forward_error(done.error());
  std::error_code failure;
  fs::rename(folder, path_ / task.key, failure);
  if (failure) {
    fs::remove_all(folder, ignored);
    if (!is_done(task)) return error("{}: {}", (path_ / task.key).string(), failure.message());
  }
  return result;
}

void SweepFolder::discard(const SweepTask& task) const {
  std::error_code ignored;
  fs::remove_all(path_ / task.key, ignored);
}

}  // namespace kinfer::cli
