// SPDX-License-Identifier: Apache-2.0
#include "fuzz_commands/kills.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <map>
#include <set>
#include <string>

#include "fuzz_commands/process.hpp"

namespace kinfer::fuzz {
namespace {

namespace fs = std::filesystem;

using Snapshot = std::map<std::string, std::string>;  // file name -> bytes

/// All files but run.json, which holds the time.
Snapshot snapshot(const fs::path& folder) {
  Snapshot files;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored))
    if (entry.path().filename() != "run.json") files[entry.path().filename().string()] = read_bytes(entry.path());
  return files;
}

std::vector<std::string> command(std::uint64_t seed, const std::string& out) {
  return {"calibrate", "--robot", "data/robot.toml", "--data", "data/poses.csv", "--out",
          out,         "--quiet", "--threads",       "1",      "--seed",         std::to_string(seed)};
}

/// Hidden folders in which results are written before they are renamed.
std::set<std::string> staging_folders(const fs::path& material) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(material))
    if (const std::string name = entry.path().filename().string(); name.find(".kinfer-") != std::string::npos)
      names.insert(name);
  return names;
}

}  // namespace

int count_mixtures(const fs::path& program, const fs::path& material, std::uint64_t runs, Rng rng) {
  const fs::path folder = material / "killed";
  std::map<std::uint64_t, Snapshot> complete;
  double seconds = 0.0;
  for (const std::uint64_t seed : {1, 2}) {
    const ProcessResult run = run_process(program, command(seed, "killed"), material, {.memory = 0});
    if (run.code > 1 || run.signal != 0) return fmt::print("calibrate fails: {}\n", run.err), 1;
    seconds = std::max(seconds, run.seconds);
    complete[seed] = snapshot(folder);
  }
  int mixtures = 0, changed = 0, killed = 0;
  for (std::uint64_t i = 0; i < runs; ++i) {
    const std::uint64_t seed = 1 + i % 2;
    const bool interrupt = rng.index(3) == 0;
    // Results are written in the last tenth: most kills are there.
    const double moment = seconds * (rng.index(4) == 0 ? rng.uniform(0.0, 1.0) : rng.uniform(0.8, 1.1));
    const Snapshot before = snapshot(folder);
    const std::set<std::string> left_before = staging_folders(material);  // by SIGKILL; the next whole run removes them
    const ProcessResult run =
        run_process(program, command(seed, "killed"), material, {.memory = 0}, moment, interrupt ? SIGINT : SIGKILL);
    const Snapshot after = snapshot(folder);
    const bool is_new = after == complete[seed], is_old = after == before;
    const bool ended = run.code == 0 || run.code == 1;
    const bool left_behind = interrupt && std::ranges::any_of(staging_folders(material), [&](const std::string& name) {
                               return !left_before.contains(name);
                             });
    // In its first milliseconds, before the program is in charge, the system ends it by the signal itself.
    const bool wrong_code = interrupt && !ended && run.code != 128 + SIGINT && run.signal != SIGINT;
    if ((!is_new && !is_old) || (ended && !is_new) || left_behind || wrong_code) {
      ++mixtures;
      fmt::print("kill {} after {:.4f} s: exit code {}, signal {}: {}{}\n", i, moment, run.code, run.signal,
                 !is_new && !is_old ? "a mixture"
                 : ended && !is_new ? "results missing"
                                    : "old or new results",
                 left_behind ? ", a folder left behind" : "");
    }
    changed += is_new && !is_old ? 1 : 0;
    killed += ended ? 0 : 1;
  }
  fmt::print("{} runs, {} killed, {} replaced the results: {} left something else than old or new results\n", runs,
             killed, changed, mixtures);
  return mixtures;
}

}  // namespace kinfer::fuzz
