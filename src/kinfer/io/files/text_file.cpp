// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/files/text_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <optional>
#include <system_error>

#include "kinfer/base/temporary_paths.hpp"
#include "kinfer/io/files/compressed_text.hpp"
#include "kinfer/io/files/file_bytes.hpp"

namespace kinfer {
namespace {

namespace fs = std::filesystem;

constexpr const char* unfinished_suffix = ".unfinished";

bool write_stream(const fs::path& path, const std::function<void(std::ostream&)>& write) {
  errno = 0;
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  if (file) write(file);
  file.close();
  return !file.fail();
}

void remove_quietly(const fs::path& path) {
  std::error_code ignored;
  fs::remove(path, ignored);
}

/// By a file without a name, which a kill cannot leave behind; by one that is removed where the file system has no
/// such.
bool is_writable_folder(const fs::path& folder) {
  if (const int nameless = ::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0600); nameless >= 0)
    return ::close(nameless) == 0;
  const fs::path probe = folder / (std::string("kinfer") + unfinished_suffix);
  const bool is_writable = write_stream(probe, [](std::ostream&) {});
  remove_quietly(probe);
  return is_writable;
}

/// A pipe has no size, and a file may grow or be cut while it is read.
Result<std::string> read_all(int file, const std::string& name) {
  constexpr std::size_t piece = 1 << 16;
  struct stat status {};
  const bool has_size = ::fstat(file, &status) == 0 && S_ISREG(status.st_mode) && status.st_size > 0;
  std::string text(has_size ? static_cast<std::size_t>(status.st_size) : 0, '\0');
  KINFER_TRY(known, read_from(file, text.data(), text.size(), name));
  text.resize(known);
  for (std::size_t count = piece; !has_size && count == piece;) {
    const std::size_t before = text.size();
    text.resize(before + piece);
    KINFER_TRY(found, read_from(file, text.data() + before, piece, name));
    count = found;
    text.resize(before + count);
  }
  return text;
}

}  // namespace

Result<std::string> read_text_file(const fs::path& path) {
  std::error_code failure;
  const fs::file_status status = fs::status(path, failure);
  if (!fs::exists(status)) return error("{}: no such file", path.string());
  if (fs::is_directory(status)) return error("{}: expected a file, found a folder", path.string());
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return error("{}: the file cannot be read (permissions?)", path.string());
  auto text_result = read_all(file, path.string());
  ::close(file);
  if (!text_result) return text_result;
  std::string text = std::move(*text_result);
  if (text.empty()) return error("{}: the file is empty", path.string());
  if (is_gzip(text)) return packed_by_gzip(path.string());
  return is_zstd(text) ? unpack_zstd_text(text, path.string()) : Result<std::string>(std::move(text));
}

std::string read_head(const fs::path& path, std::size_t size) {
  std::error_code failure;
  if (!fs::is_regular_file(path, failure)) return {};
  std::ifstream file(path, std::ios::binary);
  std::string head(size, '\0');
  file.read(head.data(), static_cast<std::streamsize>(size));
  head.resize(static_cast<std::size_t>(file.gcount()));
  return head;
}

Result<void> write_file(const fs::path& given, const std::function<void(std::ostream&)>& write) {
  std::error_code failure;
  const fs::file_status status = fs::status(given, failure);
  if (fs::is_directory(status)) return error("{}: expected a file to write, found a folder", given.string());
  // Through links, so that what they point to is replaced and not they; devices and pipes are written and not replaced.
  const fs::path path = fs::exists(status) ? fs::canonical(given, failure) : given;
  const bool is_replaced = !fs::exists(status) || fs::is_regular_file(status);
  fs::path unfinished = path;
  if (is_replaced) unfinished += unfinished_suffix;
  std::optional<TemporaryPath> until_renamed;
  if (is_replaced) until_renamed.emplace(unfinished);
  if (!write_stream(unfinished, write)) {
    const bool is_full = errno == ENOSPC || errno == EDQUOT;
    if (is_replaced) remove_quietly(unfinished);
    if (is_full) return error("{}: the file cannot be written: the disk is full", given.string());
    return error("{}: the file cannot be written; does the folder exist, and may you write there?", given.string());
  }
  if (!is_replaced) return {};
  fs::rename(unfinished, path, failure);
  if (!failure) return {};
  remove_quietly(unfinished);
  return error("{}: the file cannot be replaced ({})", given.string(), failure.message());
}

Result<void> write_text_file(const fs::path& path, std::string_view text) {
  return write_file(path,
                    [&](std::ostream& file) { file.write(text.data(), static_cast<std::streamsize>(text.size())); });
}

Result<void> create_writable_folder(const fs::path& folder) {
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (!fs::is_directory(folder, failure)) return error("{}: the output folder cannot be created", folder.string());
  if (!is_writable_folder(folder)) return error("{}: the output folder is not writable", folder.string());
  return {};
}

}  // namespace kinfer
