// SPDX-License-Identifier: Apache-2.0
#include "studies/thresholds/identification_figures.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/angle.hpp"
#include "kinfer/geometry/rotation.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/identify/pipeline.hpp"
#include "kinfer/simulate/compliant_mounts.hpp"
#include "kinfer/simulate/four_bar_linkage.hpp"
#include "kinfer/simulate/ins_recording.hpp"
#include "kinfer/simulate/log_faults.hpp"
#include "kinfer/simulate/mujoco_world.hpp"
#include "studies/support/truth_scores.hpp"

namespace kinfer::study::thresholds_study {
namespace {

struct Scene {
  std::string machine, grade = "industrial";
  Script script = Script::standard;
  Base base = Base::still;
  bool magnetometer = true, linkage = false;
  double foam = 0.0;                // [rad]
  std::optional<double> remount{};  // [s] sensor 3
  double late = 0.0;                // [s] sensor 2
};

SimulatedRecording simulated(const Scene& scene, std::uint64_t seed) {
  const Rng rng(seed);
  const auto mjcf =
      machine_mjcf(scene.machine, {.mounting = Mounting::arbitrary, .base = scene.base}, rng.stream(1)).value();
  const MujocoWorld world = MujocoWorld::load(mjcf).value();
  const Drive drive = make_drive(world.machine(), {.script = scene.script}, rng.stream(2)).value();
  const Machine machine = scene.linkage ? with_linkage(world.machine()) : world.machine();
  MachineMotion motion = scene.linkage ? linkage_motion(machine, drive, 200.0) : world.prescribe(drive, 200.0);
  MachineTruth truth = machine_truth(machine, motion);
  if (scene.foam > 0.0) motion = with_foam_mounts(std::move(motion), scene.foam, rng.stream(4));
  if (scene.remount) {
    const auto row = std::ranges::lower_bound(motion.time, *scene.remount) - motion.time.begin();
    motion = with_remount(std::move(motion), 2, static_cast<std::size_t>(row),
                          {exp_so3(Vec3(0.2, 0.3, 0.1)), Vec3(0.06, 0.0, 0.08)});
  }
  InsRecording recording = simulate_recording(machine, motion, *sensor_grade(scene.grade),
                                              {.has_magnetometer = scene.magnetometer}, rng.stream(3));
  if (scene.late > 0.0) recording = with_clock_fault(recording, {.sensor = 1, .offset = scene.late});
  return {std::move(recording), std::move(truth), scene.foam == 0.0};
}

bool matches(EstimatedJointType estimated, JointType truth) {
  return truth == JointType::prismatic ? estimated == EstimatedJointType::prismatic
                                       : estimated == EstimatedJointType::revolute;
}

struct Score {
  bool order = false;
  double types = 0.0, joints = 0.0;
  std::vector<double> lines, lengths, azimuths;  // [mm], [mm], [mrad]
  std::vector<double> ratios;                    // actual over predicted errors
  double findings = 0.0, unobservable = 0.0, unusable = 0.0;
};

void add_lengths(const std::vector<LinkEstimate>& links, const MachineTruth& truth, Score& score) {
  for (const LinkEstimate& link : links) {
    const auto t = std::ranges::find(truth.links, link.segment, &LinkTruth::segment);
    if (t != truth.links.end()) score.lengths.push_back(1e3 * std::abs(link.length - t->length));
  }
}

Score score_of(const SimulatedRecording& scene) {
  Score score;
  const auto found = identify::identify_machine(scene.recording, {.root = scene.truth.root}, Rng(1));
  if (!found) return score;
  score.order = true;
  for (const JointTruth& joint : scene.truth.joints) {
    const auto same = std::ranges::find_if(
        found->joints, [&](const JointEstimate& j) { return j.parent == joint.parent && j.child == joint.child; });
    score.joints += 1.0;
    if (same == found->joints.end())
      score.order = false;
    else
      score.types += matches(same->type, joint.type);
  }
  add_lengths(found->links, scene.truth, score);
  score.findings = static_cast<double>(found->findings.size());
  score.unusable = found->usability == Usability::do_not_use;
  for (const JointEstimate& joint : found->joints) score.unobservable += static_cast<double>(joint.unobservable.size());
  if (!scene.rigid_mounts || !score.order) return score;
  const GeometryScore geometry = geometry_score(found->joints, scene.truth);
  score.lines.push_back(1e3 * geometry.line);
  score.azimuths.push_back(1e3 * geometry.azimuth);
  for (const ScoredScalar& scalar : geometry.scalars) score.ratios.push_back(scalar.error / scalar.sd);
  return score;
}

void append(std::vector<double>& to, const std::vector<double>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

std::vector<SimulatedRecording> simulated_recordings() {
  return {simulated({.machine = "excavator-general"}, 3),
          simulated({.machine = "excavator-general"}, 13),
          simulated({.machine = "tree", .grade = "consumer", .script = Script::together}, 4),
          simulated({.machine = "tree", .grade = "consumer", .script = Script::gentle}, 14),
          simulated({.machine = "crane", .base = Base::rocking, .magnetometer = false}, 7),
          simulated({.machine = "crane", .grade = "consumer", .script = Script::gentle}, 17),
          simulated({.machine = "robot6"}, 9),
          simulated({.machine = "robot6", .foam = 1.0 * degree}, 5),
          simulated({.machine = "robot6", .grade = "consumer", .foam = 4.0 * degree}, 15),
          simulated({.machine = "excavator", .linkage = true}, 6),
          simulated({.machine = "excavator", .remount = 25.0}, 8),
          simulated({.machine = "excavator", .late = 0.04}, 10)};
}

Figures identification_figures(const std::vector<SimulatedRecording>& recordings) {
  Score sum;
  double orders = 0.0;
  for (const SimulatedRecording& recording : recordings) {
    const Score score = score_of(recording);
    orders += score.order;
    sum.types += score.types, sum.joints += score.joints;
    append(sum.lines, score.lines), append(sum.lengths, score.lengths);
    append(sum.azimuths, score.azimuths), append(sum.ratios, score.ratios);
    sum.findings += score.findings, sum.unobservable += score.unobservable, sum.unusable += score.unusable;
  }
  return {{"recordings with the right order", orders},
          {"joints of the right type", sum.types},
          {"axis lines, median [mm]", median(sum.lines)},
          {"axis lines, worst [mm]", *std::ranges::max_element(sum.lines)},
          {"azimuths, median [mrad]", median(sum.azimuths)},
          {"lengths, median [mm]", median(sum.lengths)},
          {"lengths, worst [mm]", *std::ranges::max_element(sum.lengths)},
          {"actual over predicted errors", rms(sum.ratios)},
          {"findings", sum.findings},
          {"unobservable quantities", sum.unobservable},
          {"unusable results", sum.unusable}};
}

}  // namespace kinfer::study::thresholds_study
