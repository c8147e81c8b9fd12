// SPDX-License-Identifier: Apache-2.0
#include "studies/identify/identify_sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "kinfer/geometry/statistics.hpp"
#include "kinfer/io/evidence/identification_json.hpp"
#include "kinfer/io/files/text_file.hpp"
#include "studies/support/truth_file.hpp"
#include "studies/support/truth_scores.hpp"

namespace kinfer::study {
namespace {

namespace fs = std::filesystem;

constexpr std::array swept_machines{"excavator", "excavator-general", "crane", "robot6"};

struct SweptFolders {
  fs::path logs, results;  ///< of the two sweeps
};

std::string key_of(const char* machine, int seed) {
  return fmt::format("{}_{}", machine, seed);
}

/// Runs `kinfer sweep`, which lies beside this program; what was done in an earlier run stays.
bool sweep(const fs::path& manifest, const fs::path& out) {
  const fs::path program = fs::read_symlink("/proc/self/exe").parent_path() / "kinfer";
  const std::string command =
      fmt::format("'{}' sweep '{}' --out '{}' --resume", program.string(), manifest.string(), out.string());
  return std::system(command.c_str()) == 0;
}

SweptFolders run_sweeps(const fs::path& folder, int seeds, const std::string& grade) {
  const SweptFolders folders{folder / "logs", folder / "results"};
  fs::create_directories(folder);
  std::ofstream drives(folder / "drives.csv"), tasks(folder / "identify.csv");
  drives << "key,verb,arguments\n";
  tasks << "key,verb,arguments,robot,truth\n";
  for (const char* machine : swept_machines)
    for (int seed = 1; seed <= seeds; ++seed) {
      const std::string key = key_of(machine, seed), log = (folders.logs / key).string();
      drives << fmt::format("{},simulate,{} --motion prescribed --grade {} --seed {}\n", key, machine, grade, seed);
      tasks << fmt::format("{0},identify,{1}/imu.csv --root ins0,{2},{1}/truth.json\n", key, log, machine);
    }
  drives.close(), tasks.close();
  if (!sweep(folder / "drives.csv", folders.logs) || !sweep(folder / "identify.csv", folders.results))
    fmt::print(stderr, "a sweep failed; what it has done counts\n");
  return folders;
}

struct SweptScores {
  std::vector<double> lines, directions, ratios;  ///< [m], [rad], error / sd
  int refused = 0, incomplete = 0;
};

Result<GeometryScore> score_of(const SweptFolders& folders, const std::string& key) {
  KINFER_TRY(truth, read_truth(folders.logs / key / "truth.json"));
  KINFER_TRY(text, read_text_file(folders.results / key / "evidence.json"));
  KINFER_TRY(evidence, read_identification_evidence(text));
  std::vector<JointEstimate> joints;
  for (const JointRecord& joint : evidence.joints) joints.push_back(joint.estimate);
  return geometry_score(joints, truth);
}

SweptScores scores_of(const SweptFolders& folders, const char* machine, int seeds) {
  SweptScores all;
  for (int seed = 1; seed <= seeds; ++seed) {
    const auto score = score_of(folders, key_of(machine, seed));
    if (!score) {
      ++all.refused;
      continue;
    }
    all.incomplete += score->complete ? 0 : 1;
    if (!score->complete) continue;
    all.lines.push_back(score->line), all.directions.push_back(score->direction);
    for (const ScoredScalar& scalar : score->scalars) all.ratios.push_back(scalar.error / scalar.sd);
  }
  return all;
}

void print_scores(const char* machine, const SweptScores& s) {
  if (s.lines.empty()) return fmt::print("{}: none of {} identified\n", machine, s.refused + s.incomplete);
  const auto inside = std::ranges::count_if(s.ratios, [](double r) { return std::abs(r) <= 1.96; });
  fmt::print(
      "{}: line median {:.2f} worst {:.2f} mm; direction median {:.2f} worst {:.2f} mrad; actual/predicted {:.2f}; "
      "coverage {:.1f} % of {}; {} without a result, {} incomplete\n",
      machine, 1e3 * median(s.lines), 1e3 * *std::ranges::max_element(s.lines), 1e3 * median(s.directions),
      1e3 * *std::ranges::max_element(s.directions), rms(s.ratios),
      100.0 * static_cast<double>(inside) / static_cast<double>(s.ratios.size()), s.ratios.size(), s.refused,
      s.incomplete);
}

}  // namespace

int run_identify_sweep(int argc, char** argv) {
  const int seeds = argc > 1 ? std::atoi(argv[1]) : 60;
  const fs::path folder = fs::absolute(argc > 2 ? argv[2] : "identify-sweep");
  const SweptFolders folders = run_sweeps(folder, seeds, argc > 3 ? argv[3] : "industrial");
  for (const char* machine : swept_machines) print_scores(machine, scores_of(folders, machine, seeds));
  return 0;
}

}  // namespace kinfer::study
