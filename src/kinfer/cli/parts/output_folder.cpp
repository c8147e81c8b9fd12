// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/parts/output_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <utility>

#include "kinfer/io/files/text_file.hpp"

namespace kinfer::cli {
namespace {

namespace fs = std::filesystem;

/// No signal but SIGKILL comes between the steps while it lives.
class SignalBlock {
 public:
  SignalBlock() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  ~SignalBlock() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalBlock(const SignalBlock&) = delete;
  SignalBlock& operator=(const SignalBlock&) = delete;

 private:
  sigset_t before_{};
};

/// ".NAME.kinfer-" of the hidden folders that belong to a folder.
std::string staging_prefix(const fs::path& folder) {
  return "." + folder.filename().string() + ".kinfer-";
}

/// Left by runs that were killed. Whoever holds the lock knows that they are not used.
void remove_abandoned(const fs::path& folder) {
  std::error_code ignored;
  std::vector<fs::path> abandoned;
  for (const fs::path& parent : {folder.parent_path(), folder})
    for (const auto& entry : fs::directory_iterator(parent, ignored))
      if (entry.path().filename().string().starts_with(staging_prefix(folder))) abandoned.push_back(entry.path());
  for (const fs::path& path : abandoned) fs::remove_all(path, ignored);
}

bool is_inside(const fs::path& path, const fs::path& folder) {
  const auto [end, rest] = std::ranges::mismatch(folder, path);
  return end == folder.end();
}

/// Only files and links, so that a folder with the same files can take its place.
bool holds_files_only(const fs::path& folder) {
  std::error_code failure;
  const fs::directory_iterator entries(folder, failure);
  return !failure && std::all_of(begin(entries), end(entries), [](const fs::directory_entry& entry) {
    return entry.is_symlink() || entry.is_regular_file();
  });
}

using Names = std::vector<std::string>;

bool has(const Names& names, const fs::path& path) {
  return std::ranges::find(names, path.filename().string()) != names.end();
}

/// Hard links to the files of `from` that `to` lacks: the same files, also for whoever has them open.
bool link_others(const fs::path& from, const fs::path& to, const Names& dropped) {
  std::error_code failure;
  for (const auto& entry : fs::directory_iterator(from, failure)) {
    if (has(dropped, entry.path())) continue;
    const fs::path target = to / entry.path().filename();
    if (fs::symlink_status(target).type() != fs::file_type::not_found) continue;
    if (::linkat(AT_FDCWD, entry.path().c_str(), AT_FDCWD, target.c_str(), 0) != 0) return false;
  }
  return !failure;
}

/// Files that came while the folders changed places.
void rescue_late_files(const fs::path& from, const fs::path& to, const Names& dropped) {
  std::error_code ignored;
  std::vector<fs::path> late;
  for (const auto& entry : fs::directory_iterator(from, ignored))
    if (!has(dropped, entry.path()) && !fs::exists(fs::symlink_status(to / entry.path().filename(), ignored)))
      late.push_back(entry.path());
  for (const fs::path& path : late) fs::rename(path, to / path.filename(), ignored);
}

/// File by file, which needs no descriptor: a process that may open no more leaves nothing either.
void remove_staging(const fs::path& staging, const Names& names) {
  std::error_code ignored;
  for (const std::string& name : names) ::unlink((staging / name).c_str());
  if (::rmdir(staging.c_str()) != 0) fs::remove_all(staging, ignored);
}

bool are_same_folder(int open, const fs::path& path) {
  struct stat one {
  }, other{};
  return ::fstat(open, &one) == 0 && ::stat(path.c_str(), &other) == 0 && one.st_ino == other.st_ino &&
         one.st_dev == other.st_dev;
}

}  // namespace

Result<OutputFolder> OutputFolder::make(const fs::path& given) {
  if (given.empty()) return error("the output folder has no name");
  const SignalBlock whole;  // what was made is known to who would remove it
  std::error_code failure;
  std::vector<fs::path> missing;
  for (auto folder = fs::absolute(given); !folder.empty() && !fs::exists(folder, failure);
       folder = folder.parent_path())
    missing.push_back(folder);
  if (auto ready = create_writable_folder(given); !ready) return forward_error(ready.error());
  const fs::path path = fs::canonical(given, failure);  // through links: their target is replaced, not they
  if (failure) return error("{}: the output folder cannot be used: {}", given.string(), failure.message());
  OutputFolder folder(path, std::move(missing));
  if (auto locked = folder.lock(); !locked) return forward_error(locked.error());
  remove_abandoned(path);
  if (auto made = folder.make_staging(); !made) return forward_error(made.error());
  return folder;
}

OutputFolder::OutputFolder(OutputFolder&& other) noexcept
    : path_(std::move(other.path_)),
      staging_(std::exchange(other.staging_, {})),
      made_(std::exchange(other.made_, {})),
      temporary_(std::move(other.temporary_)),
      names_(std::move(other.names_)),
      dropped_(std::move(other.dropped_)),
      lock_(std::exchange(other.lock_, -1)) {}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  if (!staging_.empty()) remove_staging(staging_, names_);
  temporary_.clear();
  for (const auto& folder : made_)  // remove() refuses to delete a folder that is not empty
    if (!fs::remove(folder, ignored)) break;
  if (lock_ >= 0) ::close(lock_);
}

Result<void> OutputFolder::lock() {
  for (int attempt = 0; attempt < 10; ++attempt) {
    lock_ = ::open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (lock_ < 0) return error("{}: the output folder cannot be opened", path_.string());
    // A file system without locks cannot tell; the run goes on.
    if (::flock(lock_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
      return error("{}: another run of kinfer is writing into this folder", path_.string());
    if (are_same_folder(lock_, path_)) return {};
    ::close(std::exchange(lock_, -1));  // the other run has just replaced the folder
  }
  return error("{}: the output folder is replaced again and again by other runs", path_.string());
}

Result<void> OutputFolder::make_staging() {
  struct stat folder {};
  ::stat(path_.c_str(), &folder);
  for (const fs::path& parent : {path_.parent_path(), path_}) {
    const fs::path staging = parent / (staging_prefix(path_) + std::to_string(::getpid()));
    struct stat made {};
    if (::mkdir(staging.c_str(), folder.st_mode & 07777) != 0) continue;
    ::stat(staging.c_str(), &made);
    if (made.st_dev == folder.st_dev) {
      for (auto missing = made_.rbegin(); missing != made_.rend(); ++missing) temporary_.emplace_back(*missing);
      temporary_.emplace_back(staging);
      staging_ = staging;
      return {};
    }
    ::rmdir(staging.c_str());  // the folder is a mount point: nothing can be renamed into it from beside
  }
  return error("{}: the output folder is not writable", path_.string());
}

fs::path OutputFolder::operator/(const std::string& name) {
  fs::path file = staging_ / name;
  if (std::ranges::find(names_, name) == names_.end()) {
    names_.push_back(name);
    temporary_.emplace_back(file);
  }
  return file;
}

fs::path OutputFolder::visible(const std::string& name) {
  if (std::ranges::find(names_, name) == names_.end()) names_.push_back(name);
  return path_ / name;
}

/// The staging folder and the folder change places, which is one step for everybody.
bool OutputFolder::replace_whole() const {
  std::error_code failure;
  const bool stands_inside = is_inside(fs::current_path(failure), path_);  // a shell would stay in the old folder
  if (staging_.parent_path() == path_ || stands_inside || !holds_files_only(path_) ||
      !link_others(path_, staging_, dropped_))
    return false;
  if (::renameat2(AT_FDCWD, staging_.c_str(), AT_FDCWD, path_.c_str(), RENAME_EXCHANGE) != 0) return false;
  rescue_late_files(staging_, path_, dropped_);
  return true;
}

Result<void> OutputFolder::replace_one_by_one() const {
  std::error_code failure;
  for (const std::string& name : names_)
    if (fs::is_directory(path_ / name, failure))
      return error("{}: expected a file to write, found a folder", (path_ / name).string());
  for (const std::string& name : names_) {
    if (!fs::exists(staging_ / name, failure)) continue;  // a file that the run had no cause to write
    fs::rename(staging_ / name, path_ / name, failure);
    if (failure) return error("{}: the file cannot be replaced ({})", (path_ / name).string(), failure.message());
  }
  for (const std::string& name : dropped_) fs::remove(path_ / name, failure);
  return {};
}

Result<void> OutputFolder::commit() {
  const SignalBlock whole;
  if (!replace_whole())
    if (auto done = replace_one_by_one(); !done) return done;
  std::error_code ignored;
  fs::remove_all(std::exchange(staging_, {}), ignored);
  temporary_.clear();
  made_.clear();
  return {};
}

}  // namespace kinfer::cli
