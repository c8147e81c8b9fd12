// SPDX-License-Identifier: Apache-2.0
// Kinematic loops: the odds of every pair of bodies in machines without a loop, and how well a four-bar linkage's
// closing joint is found:
//   ./dev study loops FOLDER [LOGS_WITHOUT [LOGS_WITH [FIRST_SEED]]]
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "kinfer/base/parallel.hpp"
#include "kinfer/estimate/continuous/knot_spacing.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/identify/loops/loop_search.hpp"
#include "kinfer/identify/loops/thresholds.hpp"
#include "kinfer/identify/refinement/fits/refinement_setup.hpp"
#include "kinfer/identify/refinement/refine.hpp"
#include "kinfer/identify/structure/joint_type.hpp"
#include "kinfer/identify/structure/ordered_motion.hpp"
#include "kinfer/inertial/sensor_grading.hpp"
#include "kinfer/simulate/four_bar_linkage.hpp"
#include "kinfer/simulate/ins_recording.hpp"
#include "kinfer/simulate/mujoco_world.hpp"
#include "studies/studies.hpp"
#include "studies/support/truth_scores.hpp"

namespace kinfer::study::loops_study {
using namespace identify;
namespace {

constexpr const char* grades[] = {"noise", "industrial", "consumer"};
constexpr Script scripts[] = {Script::standard, Script::sequential, Script::together, Script::gentle, Script::quick};

struct Case {
  std::string machine;
  std::uint64_t seed = 1;
  bool linkage = false;
};

struct Log {
  InsRecording recording;
  MachineTruth truth;
};

/// Grades, drives, bases, slopes and sensor faults in turn; 50 Hz, so that hundreds of logs take minutes.
Log simulated(const Case& c) {
  const Rng rng(c.seed);
  const std::uint64_t k = c.seed;
  const MachineOptions build{.mounting = Mounting::arbitrary,
                             .base = c.linkage ? Base::still : static_cast<Base>(k % 3),
                             .slope = Angle::deg(2.0 * static_cast<double>(k % 4))};
  const MujocoWorld world = MujocoWorld::load(machine_mjcf(c.machine, build, rng.stream(1)).value()).value();
  const Drive drive = make_drive(world.machine(), {.script = scripts[(k / 3) % 5]}, rng.stream(2)).value();
  const Machine machine = c.linkage ? with_linkage(world.machine()) : world.machine();
  const MachineMotion motion = c.linkage ? linkage_motion(machine, drive, 100.0) : world.prescribe(drive, 50.0);
  SensorModel grade = sensor_grade(grades[(k / 2) % 3]).value();
  SensorFaults faults;
  if (k % 7 == 1) faults.missing = 0.05;
  if (k % 7 == 2 && !c.linkage) grade.gyroscope.range = 0.5, grade.accelerometer.range = 13.0;
  if (k % 7 == 3) faults.has_magnetometer = false;
  if (k % 7 == 4) faults.spikes = 10.0;
  return {simulate_recording(machine, motion, grade, faults, rng.stream(3)), machine_truth(machine, motion)};
}

struct Outcome {
  bool fitted = false, found = false, correct = false;
  double log_odds = -std::numeric_limits<double>::infinity(), gap = 0.0, in_step = 0.0;
  double closing_line = 0.0, closing_direction = 0.0;  // [mm], [mrad]
  double line = 0.0, line_without = 0.0;               // [mm] worst of the others, with and without the closure
};

std::vector<InitialJoint> starts_of(const OrderedMotion& ordered) {
  const auto types = identify::joint_types(ordered.motion, ordered.tree);
  std::vector<InitialJoint> starts;
  for (std::size_t i = 1; i < ordered.tree.order.size(); ++i) {
    const std::size_t child = ordered.tree.order[i];
    starts.push_back(
        estimate_initial_joint(ordered.motion, ordered.tree, *ordered.tree.parent[child], child, types[i - 1].type));
  }
  return starts;
}

/// The fit that leaves every loop open, and the most likely one.
Outcome open_outcome(const Log& log, const OrderedMotion& ordered) {
  Outcome outcome;
  const SensorModel grade = estimate_sensor_model(log.recording);
  RefinementSetup setup = set_up_refinement(log.recording, ordered.motion, ordered.tree, starts_of(ordered), grade,
                                            select_knot_spacing(log.recording));
  const InsFit fit = fit_ins(setup.problem, setup.start, {.threads = 1});
  outcome.fitted = true;
  const auto candidates = loop_candidates(setup.problem, fit);
  if (candidates.empty()) return outcome;
  const FoundLoop& best = candidates.front();
  outcome.log_odds = best.log_odds;
  outcome.found = best.log_odds >= min_loop_log_odds;
  outcome.gap = 1e3 * best.evidence.closing.gap;
  outcome.in_step = 1e3 * best.evidence.mirrored.gap;
  return outcome;
}

double line_distance(const Vec3& point, const Vec3& truth, const Vec3& axis) {
  return 1e3 * (point - truth).cross(axis).norm();
}

double direction_error(const Vec3& axis, const Vec3& truth) {
  return 1e3 * axis.cross(truth).norm();
}

/// The closing joint's errors; the loop may be cut at any of its joints, so that it is one of the true joints.
void score_loop(const LoopEstimate& loop, const MachineTruth& truth, Outcome& outcome) {
  std::vector<JointTruth> all = truth.joints;
  all.insert(all.end(), truth.loops.begin(), truth.loops.end());
  for (const JointTruth& joint : all) {
    const bool same = joint.parent == loop.joint.parent && joint.child == loop.joint.child,
               turned = joint.child == loop.joint.parent && joint.parent == loop.joint.child;
    if (!same && !turned) continue;
    outcome.correct = true;
    const JointEstimate& e = loop.joint;
    const Vec3 &first = same ? joint.point_in_parent : joint.point_in_child,
               &second = same ? joint.point_in_child : joint.point_in_parent,
               &first_axis = same ? joint.axis_in_parent : joint.axis_in_child,
               &second_axis = same ? joint.axis_in_child : joint.axis_in_parent;
    outcome.closing_line = std::max(line_distance(e.point_in_parent, first, first_axis),
                                    line_distance(e.point_in_child, second, second_axis));
    outcome.closing_direction =
        std::max(direction_error(e.axis_in_parent, first_axis), direction_error(e.axis_in_child, second_axis));
  }
}

double worst_line(const Refinement& refined, const MachineTruth& truth) {
  std::vector<JointEstimate> joints;
  for (const RefinedJoint& joint : refined.joints) joints.push_back(joint.estimate);
  MachineTruth same = truth;
  std::erase_if(same.joints, [&](const JointTruth& t) {
    return std::ranges::none_of(joints,
                                [&](const JointEstimate& j) { return j.parent == t.parent && j.child == t.child; });
  });
  return 1e3 * geometry_score(joints, same).line;
}

Outcome linkage_outcome(const Log& log, const OrderedMotion& ordered) {
  Outcome outcome;
  const auto starts = starts_of(ordered);
  const auto refined =
      refine(log.recording, ordered.motion, ordered.tree, starts, {.fit = {.threads = 1}, .hold_out = false});
  if (!refined) return outcome;
  outcome.fitted = true;
  outcome.line = worst_line(*refined, log.truth);
  const auto open = refine(log.recording, ordered.motion, ordered.tree, starts,
                           {.fit = {.threads = 1}, .loops = LoopTreatment::open, .hold_out = false});
  outcome.line_without = open ? worst_line(*open, log.truth) : 0.0;
  outcome.found = !refined->loops.empty();
  if (!outcome.found) return outcome;
  const LoopEstimate& loop = refined->loops.front();
  outcome.log_odds = loop.log_odds;
  outcome.gap = 1e3 * loop.gap;
  outcome.in_step = 1e3 * loop.mirrored_gap;
  score_loop(loop, log.truth, outcome);
  return outcome;
}

Outcome outcome_of(const Case& c) {
  const Log log = simulated(c);
  const auto ordered = order_segments(log.recording, {}, log.truth.root, 1);
  if (!ordered) return {};
  return c.linkage ? linkage_outcome(log, *ordered) : open_outcome(log, *ordered);
}

std::vector<Outcome> run(const std::vector<Case>& cases, const std::filesystem::path& path) {
  std::vector<Outcome> outcomes(cases.size());
  parallel_for(cases.size(), 0, [&](std::size_t i) { outcomes[i] = outcome_of(cases[i]); });
  std::ofstream file(path);
  file << "machine,seed,fitted,found,correct pair,ln odds,gap [mm],mirrored gap [mm],closing line [mm],"
          "closing direction [mrad],worst other line [mm],the same with the loop open [mm]\n";
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const Outcome& o = outcomes[i];
    file << fmt::format("{},{},{:d},{:d},{:d},{:.1f},{:.2f},{:.1f},{:.2f},{:.2f},{:.2f},{:.2f}\n", cases[i].machine,
                        cases[i].seed, o.fitted, o.found, o.correct, o.log_odds, o.gap, o.in_step, o.closing_line,
                        o.closing_direction, o.line, o.line_without);
  }
  return outcomes;
}

void without_loops(const std::filesystem::path& folder, int logs, int first_seed) {
  const std::vector<std::string> machines{"excavator", "excavator-general", "crane", "robot6", "tree"};
  std::vector<Case> cases;
  for (int i = 0; i < logs; ++i)
    cases.push_back({.machine = machines[static_cast<std::size_t>(i) % machines.size()],
                     .seed = static_cast<std::uint64_t>(first_seed + i)});
  int fitted = 0, found = 0;
  double highest = -std::numeric_limits<double>::infinity();
  for (const Outcome& o : run(cases, folder / "without_loops.csv")) {
    fitted += o.fitted;
    found += o.found;
    highest = std::max(highest, o.log_odds);
  }
  fmt::print("without loops: {} logs fitted, {} loops found, highest ln odds {:.1f} (a loop from {:.1f} on)\n", fitted,
             found, highest, min_loop_log_odds);
}

void with_loops(const std::filesystem::path& folder, int logs, int first_seed) {
  std::vector<Case> cases;
  for (int i = 0; i < logs; ++i)
    cases.push_back({.machine = "excavator", .seed = static_cast<std::uint64_t>(first_seed + i), .linkage = true});
  std::vector<double> line, direction, other, open;
  int fitted = 0, correct = 0;
  double least = std::numeric_limits<double>::infinity();
  for (const Outcome& o : run(cases, folder / "linkages.csv")) {
    fitted += o.fitted;
    if (!o.correct) continue;
    ++correct;
    least = std::min(least, o.log_odds);
    line.push_back(o.closing_line);
    direction.push_back(o.closing_direction);
    other.push_back(o.line);
    open.push_back(o.line_without);
  }
  if (line.empty()) return fmt::print("linkages: {} logs fitted, none found\n", fitted);
  fmt::print(
      "linkages: {} logs fitted, {} found, least ln odds {:.1f}; closing joint: line {:.2f} mm (worst {:.2f}), "
      "direction {:.2f} mrad (worst {:.2f}); worst other line {:.2f} mm (worst {:.2f}), with the loop open {:.2f} "
      "({:.2f})\n",
      fitted, correct, least, median(line), *std::ranges::max_element(line), median(direction),
      *std::ranges::max_element(direction), median(other), *std::ranges::max_element(other), median(open),
      *std::ranges::max_element(open));
}

}  // namespace
}  // namespace kinfer::study::loops_study

int kinfer::study::run_loops(int argc, char** argv) {
  const std::filesystem::path folder = argc > 1 ? argv[1] : "studies/loops/results";
  const auto number = [&](int i, int otherwise) { return argc > i ? std::atoi(argv[i]) : otherwise; };
  std::filesystem::create_directories(folder);
  loops_study::with_loops(folder, number(3, 40), number(4, 1));
  loops_study::without_loops(folder, number(2, 600), number(4, 1));
  return 0;
}
