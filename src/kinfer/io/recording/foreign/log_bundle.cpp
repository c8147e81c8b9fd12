// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/recording/foreign/log_bundle.hpp"

#include <algorithm>
#include <array>

#include "kinfer/io/files/file_bytes.hpp"
#include "kinfer/io/files/text_file.hpp"
#include "kinfer/io/files/zip_archive.hpp"
#include "kinfer/io/recording/foreign/ins_presets.hpp"

namespace kinfer {
namespace {

namespace fs = std::filesystem;

bool may_be_log(const fs::path& file) {
  constexpr std::array extensions{".csv", ".txt", ".tsv"};
  return std::ranges::find(extensions, file.extension().string()) != extensions.end();
}

/// Takes up the logs among the files that it is shown.
class BundleReader {
 public:
  explicit BundleReader(std::string name) : name_(std::move(name)) {}

  Result<void> add(const std::string& text, const fs::path& path) {
    const std::string_view head = std::string_view(text).substr(0, std::size_t{1} << 16);
    const InsMap* preset = find_preset(head, path);
    if (preset && !preset->refuse.empty()) {
      refused_ = fmt::format("{}: {}", path.string(), preset->refuse);
      remarks_.push_back(refused_);
      return {};
    }
    if (!preset && !is_foreign_log(head)) return {};
    KINFER_TRY(log, parse_foreign_log(text, path, preset ? *preset : InsMap{}));
    logs_.push_back(std::move(log));
    return {};
  }

  Result<std::vector<ForeignLog>> finish() {
    if (logs_.empty() && !refused_.empty()) return forward_error({refused_});
    if (logs_.empty()) return error("{}: no file in it is known as a log of an accelerometer or gyroscope", name_);
    logs_.front().remarks.insert(logs_.front().remarks.end(), remarks_.begin(), remarks_.end());
    return std::move(logs_);
  }

 private:
  std::string name_, refused_;
  std::vector<ForeignLog> logs_;
  std::vector<std::string> remarks_;
};

Result<std::vector<ForeignLog>> read_archive(const fs::path& path) {
  KINFER_TRY(file, FileBytes::read(path));
  KINFER_TRY(entries, zip_entries(file.text(), path.string()));
  BundleReader reader(path.string());
  for (const ZipEntry& entry : entries) {
    if (!may_be_log(entry.name)) continue;
    KINFER_TRY(text, unpack_zip_entry(file.text(), entry, path.string()));
    if (auto done = reader.add(text, path / entry.name); !done) return forward_error(done.error());
  }
  return reader.finish();
}

Result<std::vector<ForeignLog>> read_folder(const fs::path& path) {
  std::vector<fs::path> files;
  std::error_code failure;
  for (const auto& entry : fs::directory_iterator(path, failure))
    if (entry.is_regular_file(failure) && may_be_log(entry.path())) files.push_back(entry.path());
  std::ranges::sort(files);
  BundleReader reader(path.string());
  for (const fs::path& file : files) {
    auto text = read_text_file(file);
    if (!text) continue;  // an empty file is no log
    if (auto done = reader.add(*text, file); !done) return forward_error(done.error());
  }
  return reader.finish();
}

}  // namespace

bool is_log_bundle(const fs::path& path) {
  std::error_code failure;
  if (fs::is_directory(path, failure)) return true;
  return is_zip(read_head(path, 4));
}

Result<std::vector<ForeignLog>> read_log_bundle(const fs::path& path) {
  std::error_code failure;
  return fs::is_directory(path, failure) ? read_folder(path) : read_archive(path);
}

}  // namespace kinfer
