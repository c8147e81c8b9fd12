// SPDX-License-Identifier: Apache-2.0
// The manifest of a sweep (docs/formats.md): a CSV file with one task a row, columns key, verb and arguments, and
// where they are known robot, date and truth.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "kinfer/base/result.hpp"

namespace kinfer {

// Files in a sweep's folder, beside those of its tasks.
inline constexpr std::string_view manifest_name = "manifest.csv";
inline constexpr std::string_view archive_begin = "results", archive_end = ".tar";  ///< of --pack, one a shard

struct SweepTask {
  std::string key{};                     ///< letters, digits, ".", "-" and "_": the name of the task's folder
  std::string verb{};                    ///< "calibrate"
  std::vector<std::string> arguments{};  ///< of the verb; "{out}" stands for the task's folder, "{seed}" for its seed
  std::string robot{};                   ///< whose result it is; empty: not stated
  std::string date{};                    ///< of the measurements, YYYY-MM-DD or with a time behind it: sorts as text
  std::string truth{};                   ///< robot file that made the data, of simulations; empty: unknown
  int line = 0;                          ///< in the file, from 1

  /// Robot and date say nothing about how it runs.
  bool operator==(const SweepTask& other) const {
    return key == other.key && verb == other.verb && arguments == other.arguments && truth == other.truth;
  }
};

Result<std::vector<SweepTask>> parse_manifest(std::string_view text, const std::string& name_in_messages);
Result<std::vector<SweepTask>> read_manifest(const std::filesystem::path& path);
std::string format_manifest(const std::vector<SweepTask>& tasks);

/// One task for each file that matches `pattern` (of the shell: * ? [ ]), in the order of names. The key is what the
/// wildcards matched, joined by "_". In `arguments`, "{file}" stands for the file, "{folder}" for its folder.
Result<std::vector<SweepTask>> tasks_of_files(const std::string& pattern, const std::string& verb,
                                              const std::string& arguments);

/// Splits like a shell: at blanks, outside of "…" and '…'.
Result<std::vector<std::string>> split_words(std::string_view text);

/// Of the sweep's seed and the task's key alone, whatever order, shard or engine: the first 64 bits of the SHA-256 of
/// "seed/key".
std::uint64_t task_seed(std::uint64_t sweep_seed, std::string_view key);

}  // namespace kinfer
