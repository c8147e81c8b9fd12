// SPDX-License-Identifier: Apache-2.0
// Identification of logs whose gyroscopes clip at half of the largest rate, or whose accelerometers clip at 1.3 g,
// beside the same logs without clipping: worst line, findings and joint types that are wrong, time.
//   ./dev study clipping [seeds [machine [setting ...]]]
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>

#include "kinfer/base/constants.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/identify/pipeline.hpp"
#include "kinfer/simulate/ins_recording.hpp"
#include "kinfer/simulate/mujoco_world.hpp"
#include "studies/studies.hpp"
#include "studies/support/run_settings.hpp"
#include "studies/support/truth_scores.hpp"

namespace kinfer::study::clipping_study {
namespace {

struct Setting {
  std::string name;
  double gyroscope_share = 0.0;  // range over the largest angular velocity of any sensor; 0: the grade's range
  double accelerometer = 0.0;    // [m/s²] range; 0: the grade's
};

const std::vector<Setting>& settings() {
  static const std::vector<Setting> all{{.name = "sound"},
                                        {.name = "gyroscopes", .gyroscope_share = 0.5},
                                        {.name = "accelerometers", .accelerometer = 1.3 * standard_gravity}};
  return all;
}

double largest_rate(const MachineMotion& motion) {
  double largest = 0.0;
  for (const SensorMotion& sensor : motion.sensors)
    for (const Vec3& rate : sensor.angular_velocity) largest = std::max(largest, rate.cwiseAbs().maxCoeff());
  return largest;
}

struct Log {
  bool is_complete = false;
  double line = 0.0, clipped = 0.0, seconds = 0.0;  // [m], share of the rows, [s]
  int wrong_types = 0, loops = 0, remounts = 0;
};

Log run(const std::string& machine, const Setting& setting, std::uint64_t seed) {
  const auto mjcf = machine_mjcf(machine, {}, Rng(seed).stream(1)).value();
  const MujocoWorld world = MujocoWorld::load(mjcf).value();
  const auto drive = make_drive(world.machine(), {}, Rng(seed).stream(2)).value();
  const MachineMotion moved = world.prescribe(drive, 200.0);
  const MachineTruth truth = machine_truth(world.machine(), moved);
  SensorModel grade = *sensor_grade("industrial");
  if (setting.gyroscope_share > 0.0) grade.gyroscope.range = setting.gyroscope_share * largest_rate(moved);
  if (setting.accelerometer > 0.0) grade.accelerometer.range = setting.accelerometer;
  const InsRecording recording = simulate_recording(world.machine(), moved, grade, {}, Rng(seed).stream(3));
  Log log;
  for (const InsSensor& sensor : recording.sensors) {
    const auto clipped = count(sensor, angular_velocity_clipped) + count(sensor, acceleration_clipped);
    log.clipped = std::max(log.clipped, static_cast<double>(clipped) / static_cast<double>(sensor.rows()));
  }
  const auto begin = std::chrono::steady_clock::now();
  const auto found = identify::identify_machine(recording, {.root = truth.root}, Rng(seed));
  log.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (!found) return log;
  const GeometryScore score = geometry_score(found->joints, truth);
  log.is_complete = score.complete;
  log.line = score.line;
  log.wrong_types = static_cast<int>(std::ranges::count_if(
      found->joints, [](const JointEstimate& joint) { return joint.type != EstimatedJointType::revolute; }));
  log.loops = static_cast<int>(std::ranges::count(found->findings, FindingKind::loop, &Finding::kind));
  log.remounts = static_cast<int>(std::ranges::count(found->findings, FindingKind::remounted, &Finding::kind));
  return log;
}

void run(const std::string& machine, const Setting& setting, int seeds) {
  std::vector<double> lines, seconds, clipped;
  int wrong_order = 0, loops = 0, remounts = 0, types = 0;
  for (int seed = 1; seed <= seeds; ++seed) {
    const Log log = run(machine, setting, static_cast<std::uint64_t>(seed));
    fmt::print("  seed {}: {} line {:.2f} mm, {:.0f} % clipped, {} loops, {} remounts, {} types, {:.1f} s\n", seed,
               log.is_complete ? "complete" : "wrong order", 1e3 * log.line, 100.0 * log.clipped, log.loops,
               log.remounts, log.wrong_types, log.seconds);
    if (log.is_complete) lines.push_back(1e3 * log.line);
    wrong_order += !log.is_complete, loops += log.loops, remounts += log.remounts, types += log.wrong_types;
    seconds.push_back(log.seconds);
    clipped.push_back(100.0 * log.clipped);
  }
  if (lines.empty()) return fmt::print("{} {}: no order is right\n", machine, setting.name);
  fmt::print(
      "{:<18} {:<14} {:2} logs, up to {:4.1f} % clipped: worst line median {:5.2f}, worst {:6.2f} mm; wrong: order "
      "{}, loops {}, remounts {}, types {}; {:.2f} s a log\n",
      machine, setting.name, seeds, *std::ranges::max_element(clipped), median(lines), *std::ranges::max_element(lines),
      wrong_order, loops, remounts, types, median(seconds));
}

}  // namespace
}  // namespace kinfer::study::clipping_study

int kinfer::study::run_clipping(int argc, char** argv) {
  using namespace clipping_study;
  run_settings(argc, argv, 10, settings(), [](const auto&... of) { run(of...); });
  return 0;
}
