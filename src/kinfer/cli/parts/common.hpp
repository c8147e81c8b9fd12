// SPDX-License-Identifier: Apache-2.0
// Shared by all verbs: common options, exit codes, progress.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "kinfer/base/observer.hpp"
#include "kinfer/base/result.hpp"
#include "kinfer/cli/parts/arguments.hpp"

namespace kinfer::cli {

enum ExitCode { exit_done = 0, exit_do_not_use = 1, exit_bad_input = 2, exit_internal = 3 };

struct CommonOptions {
  bool json = false;
  bool quiet = false;
  int threads = 0;
  std::uint64_t seed = 1;
};
/// Adds --json, --quiet, --threads, --seed to a verb.
void add_common_options(CLI::App& verb, CommonOptions& options);
/// --quiet alone, for verbs that are deterministic and fast.
void add_quiet_option(CLI::App& verb, bool& quiet);

/// Prints "kinfer: sentence" to stderr and returns exit_bad_input.
int fail(const Error& error);

/// An error where the file (or folder) to write is one of those that are read: what the result leaves out would be
/// lost.
Result<void> expect_other_file(const std::string& out, const std::vector<std::string>& inputs);

/// Whether `out` (-o) names standard output.
bool is_standard_output(const std::string& out);

/// An error where both the rows and --json would go to standard output: without a file to write, the rows do.
Result<void> expect_json_alone(const CommonOptions& common, const std::string& out);

/// A verb of the program and the function that runs it.
struct Verb {
  CLI::App* command = nullptr;
  std::function<int()> run;
};

/// Progress line on stderr: stage, iteration, best value and time left; only if stderr is a terminal. Erased at the
/// end.
class ProgressLine {
 public:
  explicit ProgressLine(const CommonOptions& options);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  Observer observer();

 private:
  bool shown_ = false;
  std::chrono::steady_clock::time_point last_{}, stage_began_{};
  std::string stage_;
};

}  // namespace kinfer::cli
