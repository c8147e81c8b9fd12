// SPDX-License-Identifier: Apache-2.0
// Success rate and speed of structure identification: order and joint types over every machine, drive, base, grade and
// sensor fault; the memetic search beside exhaustive search and beside paper 1's bacterial programming.
// `./dev study structure [FOLDER] [SEEDS]`; docs/development/methods/structure.md reads the tables.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "kinfer/base/parallel.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/identify/geometry/joint_geometry.hpp"
#include "kinfer/identify/programming/bacterial_search.hpp"
#include "kinfer/identify/programming/memetic_search.hpp"
#include "kinfer/identify/structure/joint_type.hpp"
#include "kinfer/identify/structure/ordered_motion.hpp"
#include "kinfer/simulate/ground_truth.hpp"
#include "kinfer/simulate/ins_recording.hpp"
#include "kinfer/simulate/mujoco_world.hpp"
#include "studies/studies.hpp"

namespace kinfer::study::structure_study {
using namespace identify;
namespace {

constexpr const char* script_names[] = {"standard", "sequential", "together", "gentle", "vigorous", "quick"};
constexpr const char* base_names[] = {"still", "rocking", "yawing"};
constexpr const char* grades[] = {"noise", "industrial", "consumer"};
constexpr const char* fault_names[] = {"none", "missing 5 %", "clipped", "no magnetometer", "moving steel", "spikes"};

struct Case {
  std::string machine;
  std::size_t script = 0, base = 0, grade = 1, faults = 0;
  double slope = 0.0;  // [deg]
  Mounting mounting = Mounting::arbitrary;
  std::uint64_t seed = 1;
  double sampling_rate = 100.0;  // [Hz]
};

struct Log {
  InsRecording recording;
  MachineTruth truth;
};

Log simulated(const Case& c) {
  const Rng rng(c.seed);
  const MachineOptions build{.mounting = c.mounting, .base = static_cast<Base>(c.base), .slope = Angle::deg(c.slope)};
  const auto world = MujocoWorld::load(machine_mjcf(c.machine, build, rng.stream(1)).value()).value();
  const Drive drive = make_drive(world.machine(), {.script = static_cast<Script>(c.script)}, rng.stream(2)).value();
  const MachineMotion motion = world.prescribe(drive, c.sampling_rate);
  SensorModel grade = sensor_grade(grades[c.grade]).value();
  SensorFaults faults;
  if (c.faults == 1) faults.missing = 0.05;
  if (c.faults == 2) grade.accelerometer.range = 12.0, grade.gyroscope.range = 0.7;
  if (c.faults == 3) faults.has_magnetometer = false;
  if (c.faults == 4) faults.magnetic_disturbance = 15.0;
  if (c.faults == 5) faults.spikes = 20.0;
  return {simulate_recording(world.machine(), motion, grade, faults, rng.stream(3)),
          machine_truth(world.machine(), motion)};
}

/// Every machine × drive × base × grade, cycling through slopes, mountings and sensor faults.
std::vector<Case> all_cases(int seeds) {
  std::vector<Case> cases;
  for (const std::string& machine : machine_names())
    for (std::size_t script = 0; script < std::size(script_names); ++script)
      for (std::size_t base = 0; base < 3; ++base)
        for (std::size_t grade = 0; grade < 3; ++grade)
          for (int k = 0; k < seeds; ++k) {
            const std::size_t i = cases.size();
            cases.push_back({.machine = machine,
                             .script = script,
                             .base = base,
                             .grade = grade,
                             .faults = (7 * i / 3 + static_cast<std::size_t>(k)) % 6,
                             .slope = 4.0 * static_cast<double>(i % 3),
                             .mounting = (i / 2) % 2 == 0 ? Mounting::as_built : Mounting::arbitrary,
                             .seed = i + static_cast<std::size_t>(k) + 1});
          }
  return cases;
}

/// The most probable type of a joint.
struct StatedType {
  double probability = 0.0;
  bool is_correct = false;
};

struct OrderOutcome {
  bool is_correct = false;
  double margin = 0.0;
  int joints = 0, correct_types = 0;
  std::vector<StatedType> types{};
};

OrderOutcome evaluate_order(const Case& c) {
  const Log log = simulated(c);
  const auto ordered = order_segments(log.recording, {}, {}, 1);
  if (!ordered) return {};
  const RecordedMotion& motion = ordered->motion;
  const SegmentTree& tree = ordered->tree;
  OrderOutcome outcome{.is_correct = motion.segments[tree.root].name == log.truth.root, .margin = tree.margin};
  const auto types = identify::joint_types(motion, tree);
  for (std::size_t i = 1; i < tree.order.size(); ++i) {
    const std::string &child = motion.segments[tree.order[i]].name,
                      &parent = motion.segments[*tree.parent[tree.order[i]]].name;
    const auto truth = std::ranges::find_if(
        log.truth.joints, [&](const JointTruth& j) { return j.parent == parent && j.child == child; });
    ++outcome.joints;
    if (truth == log.truth.joints.end()) {
      outcome.is_correct = false;
      continue;
    }
    const EstimatedJointType true_type =
        truth->type == JointType::prismatic ? EstimatedJointType::prismatic : EstimatedJointType::revolute;
    const JointTypeEvidence& type = types[i - 1];
    outcome.types.push_back({type.probabilities->of(type.type), type.type == true_type});
    outcome.correct_types += type.type == true_type ? 1 : 0;
  }
  return outcome;
}

/// Types that are stated with a probability p are right in a share p.
void print_reliability(const std::vector<OrderOutcome>& outcomes) {
  constexpr double limits[] = {0.0, 0.6, 0.8, 0.9, 0.95, 0.99, 0.999, 1.0};
  fmt::print("type stated with,joints,mean of these,right\n");
  for (std::size_t k = 0; k + 1 < std::size(limits); ++k) {
    double stated = 0.0;
    int joints = 0, right = 0;
    for (const OrderOutcome& outcome : outcomes)
      for (const StatedType& type : outcome.types)
        if (type.probability > limits[k] && type.probability <= limits[k + 1])
          stated += type.probability, ++joints, right += type.is_correct ? 1 : 0;
    if (joints > 0) fmt::print("{} to {},{},{:.4f},{}\n", limits[k], limits[k + 1], joints, stated / joints, right);
  }
}

void write_order(const std::filesystem::path& folder, int seeds) {
  const auto cases = all_cases(seeds);
  std::vector<OrderOutcome> outcomes(cases.size());
  parallel_for(cases.size(), 0, [&](std::size_t i) { outcomes[i] = evaluate_order(cases[i]); });
  std::ofstream file(folder / "order.csv");
  file << "machine,drive,base,slope [deg],mounting,grade,sensor fault,seed,correct,margin,joints,correct types\n";
  int correct = 0, joints = 0, types = 0, confident_errors = 0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const Case& c = cases[i];
    const OrderOutcome& o = outcomes[i];
    file << fmt::format("{},{},{},{},{},{},{},{},{},{:.2f},{},{}\n", c.machine, script_names[c.script],
                        base_names[c.base], c.slope, c.mounting == Mounting::as_built ? "as built" : "arbitrary",
                        grades[c.grade], fault_names[c.faults], c.seed, o.is_correct ? 1 : 0, o.margin, o.joints,
                        o.correct_types);
    correct += o.is_correct;
    confident_errors += !o.is_correct && o.margin > 2.0;
    joints += o.joints;
    types += o.correct_types;
  }
  fmt::print("order correct in {} of {} logs; wrong with a margin above 2: {}; joint types correct: {} of {}\n",
             correct, cases.size(), confident_errors, types, joints);
  print_reliability(outcomes);
}

/// One engine on one link.
struct Run {
  double ms = 0.0, cost = 0.0, line = 0.0;  // line: [mm] error of the axis line in the child
  std::int64_t evaluations = 0, to_one_percent = 0;
};

struct LinkProblem {
  std::vector<FrameState> parent, child;
  std::vector<JointSignal> signals;
  std::vector<std::size_t> rows;
  const JointTruth* truth = nullptr;
};

std::vector<LinkProblem> problems_of(const OrderedMotion& ordered, const MachineTruth& truth) {
  std::vector<LinkProblem> problems;
  const RecordedMotion& motion = ordered.motion;
  const SegmentTree& tree = ordered.tree;
  for (const std::size_t child : tree.order) {
    if (!tree.parent[child]) continue;
    const auto joint = std::ranges::find(truth.joints, motion.segments[child].name, &JointTruth::child);
    auto signals = find_joint_signals(motion, *tree.parent[child], child);
    if (signals.empty() || joint == truth.joints.end()) continue;
    problems.push_back({measured_states(motion.segments[*tree.parent[child]]), measured_states(motion.segments[child]),
                        std::move(signals),
                        informative_rows(motion, *tree.parent[child], child, JointVariableKind::hinge), &*joint});
  }
  return problems;
}

double line_error(const LinkProblem& p, const std::vector<DhLeaf>& leaves) {
  std::vector<SignalRow> poses;
  for (const std::size_t row : thin_rows(p.rows, 100)) poses.push_back(signals_at(p.signals, row));
  const Vec3 error = fit_revolute_geometry(leaves, poses).point_in_child - p.truth->point_in_child;
  return 1e3 * error.cross(p.truth->axis_in_child).norm();
}

template <class Search>
auto timed(double& ms, const Search& search) {
  const auto begin = std::chrono::steady_clock::now();
  auto result = search();
  ms = 1e3 * std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

Run memetic_run(const LinkProblem& p, const MemeticProgramming& options, std::uint64_t seed, bool everything) {
  Run run;
  const StructureSearchOutcome found = timed(run.ms, [&] {
    return everything ? search_exhaustive(p.parent, p.child, p.signals, p.rows, Enumeration{.rows = options.rows}, 1)
                      : search_memetic(p.parent, p.child, p.signals, p.rows, options, Rng(seed));
  });
  run.cost = found.cost;
  run.evaluations = found.evaluations;
  run.to_one_percent = found.evaluations_to_1_percent;
  run.line = line_error(p, found.leaves);
  return run;
}

Run bp_run(const LinkProblem& p, std::uint64_t seed) {
  Run run;
  BacterialProgramming options;
  options.bacteria.threads = 1;
  const LinkEvolution found =
      timed(run.ms, [&] { return search_bacterial(p.parent, p.child, p.signals, p.rows, options, Rng(seed)); });
  run.cost = found.cost;
  run.evaluations = found.evaluations;
  run.line = line_error(p, leaves(found.best));
  return run;
}

std::string row_of(const std::string& name, const std::vector<Run>& runs, const std::vector<Run>& optimum) {
  std::vector<double> ms, line, evaluations, first;
  int same = 0;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    ms.push_back(runs[i].ms);
    line.push_back(runs[i].line);
    evaluations.push_back(static_cast<double>(runs[i].evaluations));
    first.push_back(static_cast<double>(runs[i].to_one_percent));
    same += std::abs(runs[i].line - optimum[i].line) < 2.0;  // [mm]
  }
  return fmt::format("{},{},{:.0f},{:.0f},{:.0f},{:.1f},{:.1f},{:.2f},{:.2f},{}\n", name, runs.size(),
                     median(evaluations), *std::ranges::max_element(evaluations), *std::ranges::max_element(first),
                     median(ms), *std::ranges::max_element(ms), median(line), *std::ranges::max_element(line), same);
}

/// Standard drive, arbitrary mounting, industrial grade.
void write_engines(const std::filesystem::path& folder, int seeds, int bp_seeds) {
  std::vector<Run> bmp, all, bp, all_of_bp;
  int in_cost = 0;
  for (int seed = 1; seed <= seeds; ++seed) {
    const Log log =
        simulated({.machine = "excavator", .seed = static_cast<std::uint64_t>(seed), .sampling_rate = 200.0});
    const auto ordered = order_segments(log.recording, {}, {}, 0).value();
    MemeticProgramming options;
    options.bacteria.threads = 1;
    for (const LinkProblem& p : problems_of(ordered, log.truth)) {
      bmp.push_back(memetic_run(p, options, static_cast<std::uint64_t>(seed), false));
      all.push_back(memetic_run(p, options, 0, true));
      in_cost += bmp.back().cost <= 1.001 * all.back().cost;
      if (seed > bp_seeds) continue;
      bp.push_back(bp_run(p, static_cast<std::uint64_t>(seed)));
      all_of_bp.push_back(all.back());
    }
  }
  const std::string table =
      "engine,links,evaluations (median),evaluations (max),evaluations to within 1 % (max),ms per link (median),"
      "ms per link (max),line error [mm] (median),line error [mm] (max),within 2 mm of the optimum\n" +
      row_of("bmp", bmp, all) + row_of("enum", all, all) + row_of("bp", bp, all_of_bp);
  std::ofstream(folder / "engines.csv") << table;
  fmt::print("{}bmp's cost within 0.1 % of the optimum's: {} of {} links\n", table, in_cost, bmp.size());
}

}  // namespace
}  // namespace kinfer::study::structure_study

int kinfer::study::run_structure(int argc, char** argv) {
  const std::filesystem::path folder = argc > 1 ? argv[1] : "studies/structure/results";
  const int seeds = argc > 2 ? std::atoi(argv[2]) : 100;
  std::filesystem::create_directories(folder);
  structure_study::write_engines(folder, seeds, std::min(seeds, 2));
  structure_study::write_order(folder, std::max(1, seeds / 50));
  return 0;
}
