// SPDX-License-Identifier: Apache-2.0
// Azimuth of each limb about the fixed axis of the body that carries it: errors and coverage of its interval with sound
// magnetometers, with iron and transients, and without magnetometers on a slope.
//   ./dev study azimuth [seeds [machine [setting ...]]]
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>

#include "kinfer/geometry/statistics.hpp"
#include "kinfer/identify/refinement/refine.hpp"
#include "kinfer/identify/structure/ordered_motion.hpp"
#include "kinfer/simulate/ins_recording.hpp"
#include "kinfer/simulate/mujoco_world.hpp"
#include "studies/studies.hpp"
#include "studies/support/run_settings.hpp"
#include "studies/support/truth_geometry.hpp"

namespace kinfer::study::azimuth_study {
using namespace identify;
namespace {

struct Setting {
  std::string name;
  SensorFaults faults{};
  double slope = 0.0;  // [deg]
  Base base = Base::still;
  std::string grade = "industrial";
};

const std::vector<Setting>& settings() {
  static const std::vector<Setting> all{
      {.name = "sound"},
      {.name = "iron", .faults = {.hard_iron = 4.0, .soft_iron = 0.04, .magnetic_transients = 10.0}},
      {.name = "disturbed", .faults = {.magnetic_disturbance = 5.0}},
      {.name = "slope", .faults = {.has_magnetometer = false}, .slope = 3.0},
      {.name = "slope-sound", .slope = 3.0},
      {.name = "rocking", .faults = {.has_magnetometer = false}, .base = Base::rocking},
      {.name = "consumer", .grade = "consumer"},
  };
  return all;
}

struct Limb {
  double error = 0.0, sd = 0.0;  // [rad]
};

struct Log {
  std::vector<Limb> limbs{};
  double seconds = 0.0;
  std::string failure{};
};

Log run(const std::string& machine, const Setting& setting, std::uint64_t seed) {
  const auto mjcf =
      machine_mjcf(machine, {.base = setting.base, .slope = Angle::deg(setting.slope)}, Rng(seed).stream(1)).value();
  const MujocoWorld world = MujocoWorld::load(mjcf).value();
  const auto drive = make_drive(world.machine(), {}, Rng(seed).stream(2)).value();
  const MachineMotion moved = world.prescribe(drive, 200.0);
  const MachineTruth truth = machine_truth(world.machine(), moved);
  const InsRecording recording =
      simulate_recording(world.machine(), moved, *sensor_grade(setting.grade), setting.faults, Rng(seed).stream(3));
  const auto begin = std::chrono::steady_clock::now();
  const auto ordered = order_segments(recording, {}, truth.root, 0);
  if (!ordered) return {.failure = ordered.error().what};
  std::vector<InitialJoint> starts;
  for (std::size_t i = 1; i < ordered->tree.order.size(); ++i) {
    const std::size_t child = ordered->tree.order[i], parent = *ordered->tree.parent[child];
    starts.push_back(
        estimate_initial_joint(ordered->motion, ordered->tree, parent, child, EstimatedJointType::revolute));
  }
  const auto found = refine(recording, ordered->motion, ordered->tree, starts, {.hold_out = false});
  if (!found) return {.failure = found.error().what};
  Log log{.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count()};
  for (const JointTruth& joint : truth.joints)
    for (const RefinedJoint& refined : found->joints) {
      const JointEstimate& estimate = refined.estimate;
      if (estimate.parent != joint.parent || estimate.child != joint.child || joint.type != JointType::revolute)
        continue;
      const AlignedJoint aligned = align_azimuth(estimate, joint, truth);
      if (aligned.azimuth_is_free)
        log.limbs.push_back(
            {aligned.azimuth, std::hypot(estimate.sd.axis_in_parent[0], estimate.sd.axis_in_parent[1])});
    }
  return log;
}

void run(const std::string& machine, const Setting& setting, int seeds) {
  std::vector<double> errors, sds, seconds;
  int inside = 0, far = 0;
  for (int seed = 1; seed <= seeds; ++seed) {
    const Log log = run(machine, setting, static_cast<std::uint64_t>(seed));
    if (!log.failure.empty()) fmt::print("  seed {}: {}\n", seed, log.failure);
    for (const Limb& limb : log.limbs) {
      errors.push_back(1e3 * std::abs(limb.error));
      sds.push_back(1e3 * limb.sd);
      inside += std::abs(limb.error) <= 1.96 * limb.sd;
      far += std::abs(limb.error) > 4.0 * limb.sd;
      fmt::print("  seed {}: {:.2f} mrad, sd {:.2f}, {:.1f} s\n", seed, 1e3 * limb.error, 1e3 * limb.sd, log.seconds);
    }
    seconds.push_back(log.seconds);
  }
  if (errors.empty()) return fmt::print("{} {}: no azimuth to be found\n", machine, setting.name);
  fmt::print(
      "{:<18} {:<12} {:4} limbs  median {:6.2f}  worst {:7.2f} mrad  median sd {:6.2f}  inside 95 %: {:5.1f} %  "
      "beyond 4 sd: {}  {:.1f} s a log\n",
      machine, setting.name, errors.size(), median(errors), *std::ranges::max_element(errors), median(sds),
      100.0 * inside / static_cast<double>(errors.size()), far, median(seconds));
}

}  // namespace
}  // namespace kinfer::study::azimuth_study

int kinfer::study::run_azimuth(int argc, char** argv) {
  using namespace azimuth_study;
  run_settings(argc, argv, 10, settings(), [](const auto&... of) { run(of...); });
  return 0;
}
