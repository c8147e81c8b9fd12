// SPDX-License-Identifier: Apache-2.0
// run.json: when, where and how the results in a folder were made, and which files they are.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "kinfer/cli/parts/common.hpp"
#include "kinfer/cli/parts/output_folder.hpp"

namespace kinfer::cli {

/// Run-specific data that is kept out of evidence.json: command, time, threads, paths.
class RunRecord {
 public:
  RunRecord(std::string verb, const CommonOptions& options);
  void add_input(const std::filesystem::path& path);
  /// The folder of the results. An error where another verb has its results there: files of both would mix.
  Result<OutputFolder> open_folder(const std::filesystem::path& path) const;
  /// run.json, after all other results. Those of an earlier run of this verb that were not renewed are dropped; an
  /// error where one takes the place of an input that is no such result.
  Result<void> write(OutputFolder& folder) const;

 private:
  std::string verb_;
  CommonOptions options_;
  std::vector<std::string> inputs_;
  std::chrono::system_clock::time_point begin_;
};

/// Stores the arguments of the program, without its name, for run.json.
void store_command_line(const std::vector<std::string>& arguments);

}  // namespace kinfer::cli
