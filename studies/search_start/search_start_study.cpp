// SPDX-License-Identifier: Apache-2.0
// Does it matter where the continuous-time fit starts: at the pairwise joints, or at those of the search for each link?
// Every log is fitted from both starts to the end.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "kinfer/base/parallel.hpp"
#include "kinfer/estimate/continuous/fit_comparison.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/identify/joints/search_links.hpp"
#include "kinfer/identify/joints/searched_joint.hpp"
#include "kinfer/identify/joints/thresholds.hpp"
#include "kinfer/identify/refinement/refine.hpp"
#include "kinfer/simulate/ins_recording.hpp"
#include "kinfer/simulate/mujoco_world.hpp"
#include "studies/studies.hpp"
#include "studies/support/truth_scores.hpp"

namespace kinfer::study::search_start_study {
using namespace identify;
namespace {

/// A kind of log: what makes it easy or hard to start from.
struct Kind {
  const char* name;
  const char* grade = "industrial";
  Script script = Script::standard;
  double duration = 0.0;                               // [s]; 0: the script's own
  double accelerometer_range = 0.0, gyro_range = 0.0;  // [m/s²], [rad/s]; 0: the grade's
  bool in_step = false;                                // every joint a fixed share of one movement
};

constexpr Kind kinds[] = {{.name = "standard"},
                          {.name = "consumer", .grade = "consumer"},
                          {.name = "gentle", .script = Script::gentle},
                          {.name = "gentle, consumer", .grade = "consumer", .script = Script::gentle},
                          {.name = "quick", .script = Script::quick},
                          {.name = "short, 16 s", .script = Script::together, .duration = 16.0},
                          {.name = "short, 8 s", .script = Script::together, .duration = 8.0},
                          {.name = "clipped gyros", .gyro_range = 0.5},
                          {.name = "clipped accelerometers", .accelerometer_range = 11.0},
                          {.name = "joints in step", .script = Script::together, .in_step = true}};

/// Every joint moves as the first one does, by its own share.
void put_in_step(Drive& drive) {
  for (JointTrajectory& joint : drive.joints) {
    double size = 0.0;
    for (const Movement& movement : joint.movements)
      for (const Wave& wave : movement.waves) size = std::max(size, std::abs(wave.amplitude));
    double leader = 0.0;
    std::vector<Movement> movements = drive.joints.front().movements;
    for (const Movement& movement : movements)
      for (const Wave& wave : movement.waves) leader = std::max(leader, std::abs(wave.amplitude));
    for (Movement& movement : movements)
      for (Wave& wave : movement.waves) wave.amplitude *= size / leader;
    joint.movements = std::move(movements);
  }
}

struct Log {
  InsRecording recording;
  MachineTruth truth;
};

Log simulated(const std::string& machine, const Kind& kind, std::uint64_t seed) {
  const Rng rng(seed);
  const auto world =
      MujocoWorld::load(machine_mjcf(machine, {.mounting = Mounting::arbitrary}, rng.stream(1)).value()).value();
  Drive drive = make_drive(world.machine(), {.script = kind.script, .duration = kind.duration}, rng.stream(2)).value();
  if (kind.in_step) put_in_step(drive);
  const MachineMotion motion = world.prescribe(drive, 100.0);
  SensorModel grade = sensor_grade(kind.grade).value();
  if (kind.accelerometer_range > 0.0) grade.accelerometer.range = kind.accelerometer_range;
  if (kind.gyro_range > 0.0) grade.gyroscope.range = kind.gyro_range;
  return {simulate_recording(world.machine(), motion, grade, {}, rng.stream(3)),
          machine_truth(world.machine(), motion)};
}

/// A fit from one start.
struct Outcome {
  bool ok = false;
  double line = 0.0, direction = 0.0;  // [mm], [mrad] worst of the machine
  int iterations = 0;
  double seconds = 0.0, likelihood = 0.0;  // likelihood: −2 log
  std::vector<JointEstimate> joints;
  InsBodies bodies;
};

Outcome outcome_of(const Log& log, const OrderedMotion& ordered, const std::vector<InitialJoint>& starts) {
  const auto begin = std::chrono::steady_clock::now();
  const auto refined =
      refine(log.recording, ordered.motion, ordered.tree, starts, {.fit = {.threads = 1}, .hold_out = false});
  Outcome outcome;
  outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (!refined) return outcome;
  std::vector<JointEstimate> joints;
  for (const RefinedJoint& joint : refined->joints) joints.push_back(joint.estimate);
  const GeometryScore score = geometry_score(joints, log.truth);
  outcome = {.ok = score.complete,
             .line = 1e3 * score.line,
             .direction = 1e3 * score.direction,
             .iterations = refined->fit.iterations,
             .seconds = outcome.seconds,
             .likelihood = refined->negative_log_likelihood,
             .joints = std::move(joints),
             .bodies = refined->fit.unknowns.bodies};
  return outcome;
}

struct Trial {
  bool ordered = false;
  Outcome pairs, search;
  double advantage = 0.0;      // worst held-out cost of a fitted joint over that of its search
  JointDifference start, end;  // between the two
};

InsBodies bodies_of(const std::vector<InitialJoint>& starts) {
  InsBodies bodies;
  for (const InitialJoint& start : starts)
    for (const InsBody& body : start.bodies) bodies.push_back(body);
  return bodies;
}

Trial trial_of(const std::string& machine, const Kind& kind, std::uint64_t seed) {
  const Log log = simulated(machine, kind, seed);
  Trial trial;
  const auto ordered = order_segments(log.recording, {}, {}, 1);
  if (!ordered) return trial;
  const RecordedMotion& motion = ordered->motion;
  const auto links =
      search_links(*ordered, identify::joint_types(motion, ordered->tree), {.threads = 1}, Rng(seed), {});
  if (!links) return trial;
  const std::vector<std::string> names = segment_names(motion);
  std::vector<InitialJoint> pairs, searched;
  for (const JointResult& link : *links) {
    const auto index = [&](const std::string& name) {
      return static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
    };
    const std::size_t parent = index(link.joint.parent), child = index(link.joint.child);
    pairs.push_back(estimate_initial_joint(motion, ordered->tree, parent, child, link.joint.type));
    searched.push_back(link.joint.type == EstimatedJointType::revolute
                           ? initial_joint_at(motion, parent, child, link.joint)
                           : pairs.back());
  }
  trial.start = largest_difference(bodies_of(pairs), bodies_of(searched));
  trial.pairs = outcome_of(log, *ordered, pairs);
  trial.search = outcome_of(log, *ordered, searched);
  for (std::size_t i = 0; i < links->size() && trial.pairs.ok; ++i) {
    const JointResult& link = (*links)[i];
    if (!link.search) continue;
    const LinkFit written = fit_of_joint(trial.pairs.joints[i], motion.segments[pairs[i].parent],
                                         motion.segments[pairs[i].child], link.held_out_rows, OrientationMetric::chord);
    trial.advantage = std::max(trial.advantage, written.total / link.search->holdout.total);
  }
  if (trial.pairs.bodies.size() == trial.search.bodies.size())
    trial.end = largest_difference(trial.pairs.bodies, trial.search.bodies);
  trial.ordered = true;
  return trial;
}

void write_trials(const std::filesystem::path& folder, int seeds) {
  const std::vector<std::string> machines{"excavator-general", "crane", "robot6", "tree"};
  std::ofstream file(folder / "search_start.csv");
  file << "kind,machine,seed,start angle [mrad],start distance [mm],end angle [mrad],end distance [mm],line pairs [mm],"
          "line search [mm],iterations pairs,iterations search,seconds pairs,seconds search,-2 ln L search - pairs,"
          "held-out cost of the fit over the search's\n";
  fmt::print(
      "kind,logs,starts apart [mm] (median),(worst),same optimum,pairs better,search better,fit over search "
      "(median),(worst),line pairs [mm] (median),line search [mm] (median)\n");
  for (const Kind& kind : kinds) {
    const std::size_t count = machines.size() * static_cast<std::size_t>(seeds);
    std::vector<Trial> trials(count);
    parallel_for(count, 0, [&](std::size_t i) {
      trials[i] = trial_of(machines[i % machines.size()], kind, 1 + i / machines.size());
    });
    std::vector<double> distance, pairs, search, advantage;
    int same = 0, pairs_better = 0, search_better = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const Trial& t = trials[i];
      if (!t.ordered || !t.pairs.ok || !t.search.ok) continue;
      const double gain = t.search.likelihood - t.pairs.likelihood;
      file << fmt::format("{},{},{},{:.1f},{:.1f},{:.2f},{:.2f},{:.2f},{:.2f},{},{},{:.2f},{:.2f},{:.1f},{:.3f}\n",
                          kind.name, machines[i % machines.size()], 1 + i / machines.size(), 1e3 * t.start.angle,
                          1e3 * t.start.distance, 1e3 * t.end.angle, 1e3 * t.end.distance, t.pairs.line, t.search.line,
                          t.pairs.iterations, t.search.iterations, t.pairs.seconds, t.search.seconds, gain,
                          t.advantage);
      distance.push_back(1e3 * t.start.distance);
      pairs.push_back(t.pairs.line);
      search.push_back(t.search.line);
      advantage.push_back(t.advantage);
      same += std::abs(gain) < min_likelihood_gain;
      pairs_better += gain > min_likelihood_gain;
      search_better += gain < -min_likelihood_gain;
    }
    if (distance.empty()) continue;
    fmt::print("{},{},{:.0f},{:.0f},{},{},{},{:.3f},{:.3f},{:.2f},{:.2f}\n", kind.name, distance.size(),
               median(distance), *std::ranges::max_element(distance), same, pairs_better, search_better,
               median(advantage), *std::ranges::max_element(advantage), median(pairs), median(search));
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace kinfer::study::search_start_study

int kinfer::study::run_search_start(int argc, char** argv) {
  const std::filesystem::path folder = argc > 1 ? argv[1] : "studies/search_start/results";
  std::filesystem::create_directories(folder);
  search_start_study::write_trials(folder, argc > 2 ? std::atoi(argv[2]) : 5);
  return 0;
}
