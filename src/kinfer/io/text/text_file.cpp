// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/text/text_file.hpp"

#include <cerrno>
#include <fstream>
#include <system_error>

#include "kinfer/base/temporary_paths.hpp"

namespace kinfer {
namespace {

namespace fs = std::filesystem;

constexpr const char* unfinished_suffix = ".unfinished";

bool write_bytes(const fs::path& path, std::string_view text) {
  errno = 0;
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  file.write(text.data(), static_cast<std::streamsize>(text.size()));
  file.close();
  return !file.fail();
}

void remove_quietly(const fs::path& path) {
  std::error_code ignored;
  fs::remove(path, ignored);
}

}  // namespace

Result<std::string> read_text_file(const fs::path& path) {
  std::error_code failure;
  const fs::file_status status = fs::status(path, failure);
  if (!fs::exists(status)) return error("{}: no such file", path.string());
  if (fs::is_directory(status)) return error("{}: expected a file, found a folder", path.string());
  std::ifstream file(path, std::ios::binary);
  if (!file) return error("{}: the file cannot be read (permissions?)", path.string());
  std::string text;
  const auto size = fs::file_size(path, failure);
  if (!failure && size > 0) {
    text.resize(size);
    file.read(text.data(), static_cast<std::streamsize>(size));
    text.resize(static_cast<std::size_t>(file.gcount()));
  } else {  // a pipe has no size
    text.assign(std::istreambuf_iterator<char>(file), {});
  }
  if (file.bad()) return error("{}: reading stopped with an input error", path.string());
  if (text.empty()) return error("{}: the file is empty", path.string());
  return text;
}

Result<void> write_text_file(const fs::path& path, std::string_view text) {
  std::error_code failure;
  if (fs::is_directory(path, failure)) return error("{}: expected a file to write, found a folder", path.string());
  fs::path unfinished = path;
  unfinished += unfinished_suffix;
  const TemporaryPath until_renamed(unfinished);
  if (!write_bytes(unfinished, text)) {
    const bool is_full = errno == ENOSPC || errno == EDQUOT;
    remove_quietly(unfinished);
    if (is_full) return error("{}: the file cannot be written: the disk is full", path.string());
    return error("{}: the file cannot be written; does the folder exist, and may you write there?", path.string());
  }
  fs::rename(unfinished, path, failure);
  if (!failure) return {};
  remove_quietly(unfinished);
  return error("{}: the file cannot be replaced ({})", path.string(), failure.message());
}

Result<void> create_writable_folder(const fs::path& folder) {
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (!fs::is_directory(folder, failure)) return error("{}: the output folder cannot be created", folder.string());
  const fs::path probe = folder / (std::string("kinfer") + unfinished_suffix);
  const bool writable = write_bytes(probe, "");
  remove_quietly(probe);
  if (!writable) return error("{}: the output folder is not writable", folder.string());
  return {};
}

}  // namespace kinfer
