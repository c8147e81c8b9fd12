// SPDX-License-Identifier: Apache-2.0
// Runs whole commands with options and files that they should not get, and judges what kinfer promises of every run:
//   fuzz_commands [--seed S] [--runs N] [--jobs J] [--program PATH] [--keep DIR] [--no-memory-limit]
//   fuzz_commands --kills N     N runs of calibrate that are killed at random moments
// Exit code 0: no promise was broken. A run depends on seed and number alone: `--first K --runs 1` repeats run K.
#include <fmt/format.h>
#include <unistd.h>

#include <charconv>
#include <map>
#include <mutex>

#include "fuzz_commands/command.hpp"
#include "fuzz_commands/judge.hpp"
#include "fuzz_commands/kills.hpp"
#include "fuzz_commands/material.hpp"
#include "fuzz_commands/process.hpp"
#include "kinfer/base/parallel.hpp"

namespace kinfer::fuzz {
namespace {

namespace fs = std::filesystem;

struct FuzzOptions {
  std::uint64_t seed = 1, first = 0, runs = 500, kills = 0;
  int jobs = 2;
  fs::path program = KINFER_PROGRAM, keep;
  Limits limits;
};

bool read_number(std::string_view text, std::uint64_t& value) {
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  return code == std::errc{} && end == text.data() + text.size();
}

bool parse(const std::vector<std::string>& words, FuzzOptions& options) {
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == "--no-memory-limit") {
      options.limits.memory = 0;
      continue;
    }
    if (i + 1 >= words.size()) return false;
    const std::string& name = words[i];
    const std::string& value = words[++i];
    std::uint64_t number = 0;
    const bool is_number = read_number(value, number);
    if (name == "--program")
      options.program = fs::absolute(value);
    else if (name == "--keep")
      options.keep = fs::absolute(value);
    else if (!is_number)
      return false;
    else if (name == "--seed")
      options.seed = number;
    else if (name == "--first")
      options.first = number;
    else if (name == "--runs")
      options.runs = number;
    else if (name == "--kills")
      options.kills = number;
    else if (name == "--jobs")
      options.jobs = static_cast<int>(number);
    else
      return false;
  }
  return true;
}

std::string quoted(const std::vector<std::string>& words) {
  std::string text = "kinfer";
  for (const std::string& word : words) {
    text += " ";
    const bool is_plain = !word.empty() && word.find_first_of(" '\"\\$`;&|<>*?(){}\n") == std::string::npos;
    text += is_plain ? word : "'" + word + "'";
  }
  return text;
}

class Fuzzer {
 public:
  Fuzzer(const FuzzOptions& options, const fs::path& folder)
      : options_(options), folder_(folder), verbs_(read_option_tree(folder / "material/man")) {}

  int run() {
    parallel_for(options_.runs, options_.jobs, [&](std::size_t i) { run_one(options_.first + i); });
    fmt::print("{} runs from seed {}: {} with a broken promise; exit codes", options_.runs, options_.seed, broken_);
    for (const auto& [code, count] : codes_) fmt::print(" {}: {}", code, count);
    fmt::print("\n");
    return broken_ == 0 ? 0 : 1;
  }

 private:
  void run_one(std::uint64_t number) {
    Rng rng = Rng(options_.seed).stream(number);
    const fs::path folder = folder_ / fmt::format("run{}", number);
    fs::create_directories(folder);
    const FuzzedCommand command = draw_command(verbs_, folder_ / "material", folder, rng);
    const ProcessResult result = run_process(options_.program, command.words, folder, options_.limits);
    const auto broken = broken_promises(result, command.words, command.changed, folder);
    const std::lock_guard lock(printing_);
    ++codes_[result.signal != 0 ? -result.signal : result.code];
    if (!broken.empty()) report(number, command, result, broken, folder);
    fs::remove_all(folder);
  }

  void report(std::uint64_t number, const FuzzedCommand& command, const ProcessResult& result,
              const std::vector<std::string>& broken, const fs::path& folder) {
    ++broken_;
    fmt::print("run {}: {}\n  {} ({:.1f} s)\n", number, fmt::join(broken, "; "), quoted(command.words), result.seconds);
    if (!result.err.empty()) fmt::print("  {}\n", result.err.substr(0, 300));
    std::fflush(stdout);
    if (options_.keep.empty()) return;
    fs::create_directories(options_.keep);
    fs::copy(folder, options_.keep / folder.filename(),
             fs::copy_options::recursive | fs::copy_options::overwrite_existing);
  }

  const FuzzOptions& options_;
  fs::path folder_;
  std::vector<FuzzedVerb> verbs_;
  std::mutex printing_;
  std::map<int, int> codes_;
  int broken_ = 0;
};

int main(const std::vector<std::string>& words) {
  FuzzOptions options;
  if (!parse(words, options)) {
    fmt::print(
        stderr,
        "fuzz_commands [--seed S] [--first K] [--runs N] [--jobs J] [--program PATH] [--keep DIR] | --kills N\n");
    return 2;
  }
  const fs::path folder = fs::temp_directory_path() / fmt::format("kinfer_fuzz_commands_{}", ::getpid());
  const std::string failed = make_material(options.program, folder / "material", options.limits);
  if (!failed.empty()) {
    fmt::print(stderr, "the inputs cannot be made: {}\n", failed);
    return 2;
  }
  const int code =
      options.kills > 0
          ? std::min(1, count_mixtures(options.program, folder / "material", options.kills, Rng(options.seed)))
          : Fuzzer(options, folder).run();
  fs::remove_all(folder);
  return code;
}

}  // namespace
}  // namespace kinfer::fuzz

int main(int argc, char** argv) {
  return kinfer::fuzz::main({argv + std::min(argc, 1), argv + argc});
}
