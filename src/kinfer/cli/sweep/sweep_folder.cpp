// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/sweep/sweep_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <set>
#include <thread>
#include <utility>

#include "kinfer/base/instruction_set.hpp"
#include "kinfer/cli/sweep/sweep_manifest.hpp"
#include "kinfer/io/files/text_file.hpp"
#include "kinfer/io/text/replace_all.hpp"

namespace kinfer::cli {
namespace {

namespace fs = std::filesystem;

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
                                      bool may_resume, ResultStorage storage) {
  std::error_code failure;
  fs::create_directories(path, failure);
  const FolderTurn turn(path);
  if (auto ready = create_writable_folder(path); !ready) return forward_error(ready.error());
  if (auto checked = check_manifest(path, tasks, may_resume); !checked) return forward_error(checked.error());
  const std::string part = shard.parts == 1 ? "" : fmt::format("-{}-of-{}", shard.part, shard.parts);
  const int lock = ::open((path / (".lock" + part)).c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  SweepFolder folder(path, lock);
  if (lock < 0) return error("{}: cannot be locked", path.string());
  if (!take_lock(lock)) return error("{}: another sweep works in this folder", path.string());
  remove_unfinished(path, tasks, shard);
  if (auto written = update_manifest(path, tasks); !written) return forward_error(written.error());
  if (storage == ResultStorage::archive)
    if (auto ready = folder.pack_results(fmt::format("{}{}{}", archive_begin, part, archive_end)); !ready)
      return forward_error(ready.error());
  KINFER_TRY(packed, packed_results(path));
  folder.packed_ = std::move(packed);
  return folder;
}

SweepFolder::SweepFolder(SweepFolder&& other) noexcept
    : path_(std::move(other.path_)),
      lock_(std::exchange(other.lock_, -1)),
      packed_(std::move(other.packed_)),
      pack_(std::move(other.pack_)),
      scratch_(std::exchange(other.scratch_, {})) {}

SweepFolder::~SweepFolder() {
  std::error_code ignored;
  if (!scratch_.empty()) fs::remove_all(scratch_, ignored);
  if (lock_ >= 0) ::close(lock_);
}

Result<void> SweepFolder::pack_results(const std::string& name) {
  KINFER_TRY(pack, TaskPack::open(path_ / name));
  pack_.emplace(std::move(pack));
  std::error_code failure;
  const fs::path scratch = fs::temp_directory_path(failure) / fmt::format("kinfer-sweep-{}", ::getpid());
  if (!failure) fs::create_directory(scratch, failure);
  if (failure) return error("{}: {}", scratch.string(), failure.message());
  scratch_ = scratch;
  return {};
}

bool SweepFolder::is_done(const SweepTask& task) const {
  return packed_.contains(task.key) || fs::exists(path_ / task.key);
}

Result<TaskRecord> SweepFolder::result_of(const SweepTask& task) const {
  const auto packed = packed_.find(task.key);
  KINFER_TRY(text,
             read_task_file(packed != packed_.end() ? packed->second : TaskResults{path_ / task.key, {}}, "task.json"));
  if (!text) return error("{}: no record of a task", task.key);
  return parse_task_record(*text);
}

fs::path SweepFolder::running(const SweepTask& task) const {
  return (scratch_.empty() ? path_ : scratch_) / fmt::format(".{}.{}", task.key, ::getpid());
}

Result<fs::path> SweepFolder::begin(const SweepTask& task) const {
  const fs::path folder = running(task);
  std::error_code failure;
  fs::remove_all(folder, failure);
  if (!fs::create_directory(folder, failure))
    return error("{}: the folder cannot be made ({})", folder.string(), failure.message());
  return folder;
}

Result<TaskRecord> SweepFolder::end(const SweepTask& task, std::uint64_t seed, int exit_code, int signal) {
  const fs::path folder = running(task);
  TaskRecord record{.verb = task.verb, .exit_code = exit_code, .signal = signal, .processor_class = processor_class()};
  std::error_code ignored;
  for (const char* name : {"output.txt", "messages.txt"}) {
    if (fs::file_size(folder / name, ignored) == 0)
      fs::remove(folder / name, ignored);
    else
      hide_folder(folder / name, folder.string());
  }
  if (signal != 0)
    record.sentence = fmt::format("the program was ended by signal {}", signal);
  else if (exit_code > 1)
    record.sentence = last_complaint(folder / "messages.txt");
  if (auto done = write_text_file(folder / "task.json", format_task_record(task, seed, record)); !done)
    return forward_error(done.error());
  if (auto done = pack_ ? put_into_pack(task, folder) : put_in_place(task, folder); !done)
    return forward_error(done.error());
  return record;
}

Result<void> SweepFolder::put_in_place(const SweepTask& task, const fs::path& folder) const {
  std::error_code failure, ignored;
  fs::rename(folder, path_ / task.key, failure);
  if (!failure) return {};
  fs::remove_all(folder, ignored);
  if (is_done(task)) return {};  // by somebody else
  return error("{}: {}", (path_ / task.key).string(), failure.message());
}

Result<void> SweepFolder::put_into_pack(const SweepTask& task, const fs::path& folder) {
  KINFER_TRY(at, pack_->append(task.key, folder, {"task.json", "summary.json", "information.json"}));
  packed_[task.key] = {pack_->path(), at};
  std::error_code ignored;
  fs::remove_all(folder, ignored);
  return {};
}

void SweepFolder::discard(const SweepTask& task) {
  std::error_code ignored;
  packed_.erase(task.key);
  fs::remove_all(path_ / task.key, ignored);
}

}  // namespace kinfer::cli
