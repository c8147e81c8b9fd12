// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/parts/common.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

#include "kinfer/cli/parts/terminal.hpp"

namespace kinfer::cli {

void add_quiet_option(CLI::App& verb, bool& quiet) {
  begin_group(verb, "Output and repeatability");
  add_flag(verb, "--quiet", quiet, "No progress, no summary; errors are still printed");
}

void add_common_options(CLI::App& verb, CommonOptions& options) {
  begin_group(verb, "Output and repeatability");
  add_flag(verb, "--json", options.json, "Print the verdict and the headline figures as one JSON object");
  add_quiet_option(verb, options.quiet);
  add_count(verb, "--threads", options.threads, 0, 1024,
            "Number of threads; 0: all cores. Results do not depend on it");
  add_seed(verb, "--seed", options.seed, "Seed of everything random");
}

int fail(const Error& error) {
  print_message("kinfer: {}\n", error.what);
  return exit_bad_input;
}

Result<void> expect_other_file(const std::string& out, const std::vector<std::string>& inputs) {
  for (const std::string& input : inputs) {
    std::error_code missing;
    if (!out.empty() && !input.empty() && std::filesystem::equivalent(out, input, missing))
      return error("{}: is read, too, and would be lost; write to another place", out);
  }
  return {};
}

bool is_standard_output(const std::string& out) {
  return out.empty() || out == "-";
}

Result<void> expect_json_alone(const CommonOptions& common, const std::string& out) {
  if (common.json && is_standard_output(out))
    return error("--json: needs -o FILE for the rows, which go to standard output otherwise");
  return {};
}

ProgressLine::ProgressLine(const CommonOptions& options) : shown_(!options.quiet && isatty(fileno(stderr)) != 0) {}

ProgressLine::~ProgressLine() {
  if (shown_) print_progress("");
}

Observer ProgressLine::observer() {
  if (!shown_) return {};
  return [this](const Progress& progress) {
    const auto now = std::chrono::steady_clock::now();
    const std::string stage = fmt::format("{} {}", progress.stage, progress.detail);
    if (stage != stage_) stage_ = stage, stage_began_ = now;
    if (now - last_ > std::chrono::milliseconds(50)) {
      last_ = now;
      const double seconds = std::chrono::duration<double>(now - stage_began_).count();
      print_progress(fmt::format("{}  {}{}", stage,
                                 progress.iteration > 0
                                     ? fmt::format("iteration {}  best {:.6g}", progress.iteration, progress.best)
                                     : fmt::format("{:.0f} %", 100.0 * progress.fraction),
                                 time_left(seconds, progress.fraction)));
    }
    return ObserverDecision::proceed;
  };
}

}  // namespace kinfer::cli
