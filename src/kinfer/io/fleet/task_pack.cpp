// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/fleet/task_pack.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <numeric>
#include <utility>

#include "kinfer/io/files/text_file.hpp"

namespace kinfer {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t tar_block = 512;                          // [bytes]
constexpr std::size_t task_header = 2 * tar_block;              // the comment's header and its text
constexpr std::string_view comment = "comment=kinfer-task/1 ";  // then "KEY BYTES\n"

std::size_t in_blocks(std::size_t bytes) {
  return (bytes + tar_block - 1) / tar_block * tar_block;
}

/// POSIX ustar, IEEE Std 1003.1: field offsets and widths in bytes.
struct TarField {
  std::size_t at, width;
};
constexpr TarField tar_name{0, 100}, tar_mode{100, 8}, tar_size{124, 12}, tar_time{136, 12}, tar_sum{148, 8},
    tar_kind{156, 1}, tar_magic{257, 8}, tar_prefix{345, 155};

/// The sum of all bytes, that of the sum's own field taken as blanks.
unsigned tar_checksum(std::string_view block) {
  unsigned sum = 0;
  for (std::size_t i = 0; i < tar_block; ++i)
    sum += i >= tar_sum.at && i < tar_sum.at + tar_sum.width ? ' ' : static_cast<unsigned char>(block[i]);
  return sum;
}

/// Owner, rights and time are none of the result's: the same files give the same bytes.
std::string tar_header(const std::string& prefix, const std::string& name, std::size_t size, char kind) {
  std::string block(tar_block, '\0');
  const auto put = [&](const TarField& field, const std::string& text) {
    std::copy_n(text.begin(), std::min(text.size(), field.width),
                block.begin() + static_cast<std::ptrdiff_t>(field.at));
  };
  put(tar_name, name), put(tar_prefix, prefix), put(tar_mode, "0000644"), put(tar_time, "00000000000");
  put({108, 8}, "0000000"), put({116, 8}, "0000000"), put(tar_kind, std::string(1, kind));
  put(tar_size, fmt::format("{:011o}", size)), put(tar_magic, std::string("ustar\00000", 8));
  put(tar_sum, fmt::format("{:06o}", tar_checksum(block)) + std::string("\0 ", 2));
  return block;
}

std::string_view tar_text(std::string_view block, const TarField& field) {
  const std::string_view text = block.substr(field.at, field.width);
  return text.substr(0, text.find('\0'));
}

std::optional<std::uint64_t> tar_number(std::string_view block, const TarField& field, int base) {
  const std::string_view text = tar_text(block, field);
  std::uint64_t value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  return code == std::errc{} && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

bool is_tar_header(std::string_view block) {
  const std::string_view sum = block.substr(tar_sum.at, 6);
  unsigned stated = 0;
  const auto read = std::from_chars(sum.data(), sum.data() + sum.size(), stated, 8);
  return block.substr(tar_magic.at, 5) == "ustar" && read.ec == std::errc{} && stated == tar_checksum(block);
}

/// Header and text of the comment, two blocks.
std::string header_of_task(const std::string& key, std::uint64_t bytes) {
  std::string text = fmt::format("{}{} {:020}\n", comment, key, bytes);
  constexpr std::size_t most_of_two_digits = 99;
  const std::size_t length = text.size() + 3;  // with itself, in two digits or three, and a blank
  text = fmt::format("{} {}", length <= most_of_two_digits ? length : length + 1, text);
  std::string block = tar_header("", "task", text.size(), 'x') + text;
  block.resize(task_header, '\0');
  return block;
}

std::optional<PackedTask> parse_header_of_task(std::string_view header, std::uint64_t offset) {
  const auto size = is_tar_header(header) ? tar_number(header, tar_size, 8) : std::nullopt;
  if (!size || *size > tar_block || header[tar_kind.at] != 'x') return std::nullopt;
  std::string_view text = header.substr(tar_block, *size);
  const std::size_t at = text.find(comment);
  if (at == std::string_view::npos) return std::nullopt;
  text.remove_prefix(at + comment.size());
  const std::size_t blank = text.find(' ');
  if (blank == std::string_view::npos) return std::nullopt;
  PackedTask task{.key = std::string(text.substr(0, blank)), .offset = offset};
  const std::string_view bytes = text.substr(blank + 1, text.size() - blank - 2);
  const auto read = std::from_chars(bytes.data(), bytes.data() + bytes.size(), task.size);
  const bool is_whole = read.ec == std::errc{} && task.size >= task_header && task.size % tar_block == 0;
  return is_whole ? std::optional(task) : std::nullopt;
}

bool read_at(std::ifstream& file, std::uint64_t offset, std::string& bytes) {
  file.clear();
  file.seekg(static_cast<std::streamoff>(offset));
  return static_cast<bool>(file.read(bytes.data(), static_cast<std::streamsize>(bytes.size())));
}

bool write_whole(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

/// Below `folder`, those of `first` first and the others by name.
std::vector<fs::path> files_to_pack(const fs::path& folder, const std::vector<std::string>& first) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) files.push_back(fs::relative(entry.path(), folder));
  const auto rank = [&](const fs::path& file) {
    return std::pair(std::ranges::find(first, file.string()) - first.begin(), file.string());
  };
  std::ranges::sort(files, {}, rank);
  return files;
}

Result<std::string> members_of_task(const std::string& key, const fs::path& folder,
                                    const std::vector<std::string>& first) {
  std::string bytes;
  for (const fs::path& file : files_to_pack(folder, first)) {
    const std::string prefix = (fs::path(key) / file.parent_path()).lexically_normal().string();
    const std::string name = file.filename().string();
    std::ifstream source(folder / file, std::ios::binary);
    std::string content(fs::file_size(folder / file), '\0');
    if (!source.read(content.data(), static_cast<std::streamsize>(content.size())))
      return error("{}: cannot be read", (folder / file).string());
    constexpr std::uint64_t largest = 1ULL << 33;  // of a size of eleven octal digits
    if (name.size() > tar_name.width || prefix.size() > tar_prefix.width || content.size() >= largest)
      return error("{}: too long a name, or too large, for an archive", (folder / file).string());
    bytes +=
        tar_header(prefix.ends_with('/') ? prefix.substr(0, prefix.size() - 1) : prefix, name, content.size(), '0');
    bytes += content;
    bytes.resize(in_blocks(bytes.size()), '\0');
  }
  return bytes;
}

}  // namespace

Result<std::vector<PackedTask>> packed_tasks(const fs::path& pack) {
  std::ifstream file(pack, std::ios::binary);
  std::error_code failure;
  const std::uint64_t size = fs::file_size(pack, failure);
  if (!file || failure) return error("{}: cannot be read", pack.string());
  std::vector<PackedTask> tasks;
  std::string header(task_header, '\0');
  for (std::uint64_t at = 0; at + task_header <= size;) {
    if (!read_at(file, at, header)) return error("{}: cannot be read", pack.string());
    const auto task = parse_header_of_task(header, at);
    if (!task) return error("{}: no task of a sweep at byte {}", pack.string(), at);
    if (task->size > size - at) break;  // a run was killed while it wrote
    at += task->size;
    tasks.push_back(*task);
  }
  return tasks;
}

Result<std::optional<std::string>> read_packed_file(const fs::path& pack, std::uint64_t offset,
                                                    const std::string& name) {
  std::ifstream file(pack, std::ios::binary);
  std::string header(task_header, '\0');
  if (!file || !read_at(file, offset, header)) return error("{}: cannot be read", pack.string());
  const auto task = parse_header_of_task(header, offset);
  if (!task) return error("{}: no task of a sweep at byte {}", pack.string(), offset);
  header.resize(tar_block);
  for (std::uint64_t at = offset + task_header; at < offset + task->size;) {
    if (!read_at(file, at, header)) return error("{}: cannot be read", pack.string());
    const auto size = is_tar_header(header) ? tar_number(header, tar_size, 8) : std::nullopt;
    if (!size || at + tar_block + *size > offset + task->size)
      return error("{}: no file of a task at byte {}", pack.string(), at);
    if (tar_text(header, tar_name) == name && tar_text(header, tar_prefix) == task->key) {
      std::string bytes(*size, '\0');
      if (!read_at(file, at + tar_block, bytes)) return error("{}: cannot be read", pack.string());
      return bytes;
    }
    at += tar_block + in_blocks(*size);
  }
  return std::optional<std::string>();
}

Result<TaskPack> TaskPack::open(const fs::path& path) {
  const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  TaskPack pack(path, file);
  if (file < 0) return error("{}: {}", path.string(), std::strerror(errno));
  KINFER_TRY(tasks, packed_tasks(path));
  const std::uint64_t end = tasks.empty() ? 0 : tasks.back().offset + tasks.back().size;
  if (::ftruncate(file, static_cast<off_t>(end)) != 0) return error("{}: {}", path.string(), std::strerror(errno));
  return pack;
}

TaskPack::TaskPack(TaskPack&& other) noexcept : path_(std::move(other.path_)), file_(std::exchange(other.file_, -1)) {}

TaskPack::~TaskPack() {
  if (file_ >= 0) ::close(file_);
}

Result<std::uint64_t> TaskPack::append(const std::string& key, const fs::path& folder,
                                       const std::vector<std::string>& first) {
  KINFER_TRY(members, members_of_task(key, folder, first));
  const off_t at = ::lseek(file_, 0, SEEK_END);
  const bool is_written =
      at >= 0 && write_whole(file_, header_of_task(key, task_header + members.size())) && write_whole(file_, members);
  if (is_written) return static_cast<std::uint64_t>(at);
  const int why = errno;
  if (at >= 0 && ::ftruncate(file_, at) != 0) return error("{}: cannot be restored", path_.string());
  return why == ENOSPC ? error("{}: the disk is full", path_.string())
                       : error("{}: {}", path_.string(), std::strerror(why));
}

}  // namespace kinfer
