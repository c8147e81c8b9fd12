// SPDX-License-Identifier: Apache-2.0
// Verdicts on sound logs and on nonsense: how many may be used, per kind; the verdicts of the joints; of the joints of
// sound logs that may be used, how many are farther from the truth than three standard deviations.
//
//   ./dev study verdict --help
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>

#include "kinfer/identify/pipeline.hpp"
#include "kinfer/identify/screening/connection.hpp"
#include "kinfer/identify/structure/joint_type.hpp"
#include "kinfer/identify/structure/ordered_motion.hpp"
#include "kinfer/io/recording/ins_csv.hpp"
#include "studies/studies.hpp"
#include "studies/support/arguments.hpp"
#include "studies/support/corpus.hpp"
#include "studies/support/truth_scores.hpp"

namespace kinfer::study::verdict_study {
using namespace identify;
namespace {

struct Options {
  int sound = 100, nonsense = 60, seed = 1, threads = 0;
  bool connections = false;
  std::string only;
  std::vector<std::string> logs;
};

/// The features that the verdict rests on, without any fit of the chain.
void print_connections(const JudgedLog& log, int threads) {
  const auto ordered = order_segments(log.recording, {}, {}, threads);
  if (!ordered) {
    fmt::print("{},{},error,{}\n", log.kind, log.name, ordered.error().what);
    return;
  }
  const auto names = segment_names(ordered->motion);
  const auto types = identify::joint_types(ordered->motion, ordered->tree);
  std::size_t i = 0;
  for (const PairConnection& c : tree_connections(ordered->motion, ordered->tree, threads)) {
    fmt::print("{},{},{}-{},{}", log.kind, log.name, names[c.parent], names[c.child], name(types[i++].type));
    const auto print = [](const JointConnection& j) {
      fmt::print(",{:.2f},{:.2f},{:.2f},{:.3f}", j.force_gain, j.rate_gain, j.residual, j.shifted_residual);
    };
    print(c.whole);
    for (const PartConnection& half : c.halves) print(half.connection);
    fmt::print(",{:.4f},{:.2f}\n", ordered->tree.pair(c.parent, c.child).residual(), ordered->tree.margin);
  }
}

struct KindCounts {
  int use = 0, care = 0, refused = 0, errors = 0, logs = 0;
  std::map<JointUsability, int> joints;
  int used_joints_off = 0;  // said "use", and beyond three standard deviations of the truth
  double slowest = 0.0;     // [s]
};

/// Joints said to be usable of which some scalar is farther than three standard deviations from the truth, or which the
/// machine does not have.
int usable_joints_off(const Identification& found, const MachineTruth& truth) {
  const GeometryScore score = geometry_score(found.joints, truth);
  int off = 0;
  for (const JointVerdict& verdict : found.verdicts) {
    if (verdict.usability != JointUsability::use) continue;
    const auto t = std::ranges::find_if(
        truth.joints, [&](const JointTruth& joint) { return joint.parent + "-" + joint.child == verdict.joint; });
    off += t == truth.joints.end() || std::ranges::any_of(score.scalars, [&](const ScoredScalar& s) {
             return s.name.starts_with(t->name + " ") && std::abs(s.error) > 3.0 * s.sd;
           });
  }
  return off;
}

void print_log(const JudgedLog& log, const Identification& found, double seconds) {
  fmt::print("{}: {} ({:.1f} s)", log.name, name(found.usability), seconds);
  for (const JointVerdict& v : found.verdicts) {
    fmt::print("; {} {} {:.1f}", v.joint, name(v.usability), v.connection.gain());
    for (const JointDoubt& doubt : v.doubts) fmt::print(" {}", name(doubt.kind));
  }
  for (const Finding& f : found.findings) fmt::print("; {}", name(f.kind));
  fmt::print("\n");
}

void judge(const JudgedLog& log, const Options& options, KindCounts& counts) {
  const auto begin = std::chrono::steady_clock::now();
  const auto found = identify_machine(log.recording, {.threads = options.threads}, Rng(1));
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  ++counts.logs;
  counts.slowest = std::max(counts.slowest, seconds);
  if (!found) {
    ++counts.errors;
    fmt::print("{}: {} ({:.1f} s)\n", log.name, found.error().what, seconds);
    return;
  }
  print_log(log, *found, seconds);
  std::fflush(stdout);
  ++(found->usability == Usability::use             ? counts.use
     : found->usability == Usability::use_with_care ? counts.care
                                                    : counts.refused);
  for (const JointVerdict& v : found->verdicts) ++counts.joints[v.usability];
  if (log.truth) counts.used_joints_off += usable_joints_off(*found, *log.truth);
}

void print_table(const std::map<std::string, KindCounts>& kinds) {
  fmt::print("\n{:<12} {:>5} {:>5} {:>5} {:>11} {:>6} | joints {:>5} {:>5} {:>11} {:>8} | {:>16} {:>10}\n", "kind",
             "logs", "use", "care", "do not use", "error", "use", "care", "do not use", "unknown", "use beyond 3 sd",
             "slowest [s]");
  for (const auto& [kind, c] : kinds) {
    const auto joints = [&counted = c.joints](JointUsability u) { return counted.contains(u) ? counted.at(u) : 0; };
    fmt::print("{:<12} {:>5} {:>5} {:>5} {:>11} {:>6} |        {:>5} {:>5} {:>11} {:>8} | {:>16} {:>10.1f}\n", kind,
               c.logs, c.use, c.care, c.refused, c.errors, joints(JointUsability::use),
               joints(JointUsability::use_with_care), joints(JointUsability::do_not_use),
               joints(JointUsability::unknown), c.used_joints_off, c.slowest);
  }
}

std::vector<JudgedLog> real_logs(const std::vector<std::string>& paths) {
  std::vector<JudgedLog> logs;
  for (const std::string& path : paths)
    if (auto recording = read_ins_csv(path))
      logs.push_back({"real", path, std::move(*recording)});
    else
      fmt::print("{}\n", recording.error().what);
  return logs;
}

/// Calls `take` with every log of the corpus.
template <class Take>
void for_each_log(const Options& options, const Take& take) {
  for (JudgedLog& log : real_logs(options.logs)) take(log);
  const auto wanted = [&](const std::string& kind) { return options.only.empty() || options.only == kind; };
  if (!options.logs.empty()) return;
  const auto seed = static_cast<std::uint64_t>(options.seed);
  for (std::size_t i = 0; wanted("sound") && i < static_cast<std::size_t>(options.sound); ++i)
    take(sound_log(1000 * seed + i, i));
  const auto& kinds = nonsense_kinds();
  for (std::size_t i = 0; i < static_cast<std::size_t>(options.nonsense); ++i)
    if (const std::string& kind = kinds[i % kinds.size()]; wanted(kind))
      take(nonsense_log(kind, 2000 * seed + i, i / kinds.size()));
}

int run(const Options& options) {
  if (options.connections) {
    for_each_log(options, [&](const JudgedLog& log) { print_connections(log, options.threads); });
    return 0;
  }
  std::map<std::string, KindCounts> kinds;
  for_each_log(options, [&](const JudgedLog& log) { judge(log, options, kinds[log.kind]); });
  print_table(kinds);
  return 0;
}

}  // namespace
}  // namespace kinfer::study::verdict_study

int kinfer::study::run_verdict(int argc, char** argv) {
  verdict_study::Options options;
  ArgumentParser app("Verdicts on sound logs and on nonsense");
  app.add_option("--sound", options.sound, "Sound logs");
  app.add_option("--nonsense", options.nonsense, "Logs of nonsense, of all kinds in turn");
  app.add_option("--seed", options.seed, "First seed");
  app.add_option("--only", options.only, "Kind of logs: sound, or one of nonsense");
  app.add_option("--threads", options.threads, "0: all cores");
  app.add_option("--connections", options.connections, "1: the features that the verdict rests on, without any fit");
  app.add_option("LOG", options.logs, "INS logs to judge instead");
  if (const auto code = app.exit_code(argc, argv)) return *code;
  return verdict_study::run(options);
}
