// SPDX-License-Identifier: Apache-2.0
#include "studies/thresholds/tracking_figures.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "studies/track/scores.hpp"

namespace kinfer::study::thresholds_study {
using namespace track_study;
namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr double duration = 60.0, fault_begin = 30.0;  // [s]

/// The sensor's turn is named, or the joint with play or one of the sensors beside it.
bool names(const TrackAlarm& alarm, const InjectedFault& fault) {
  if (alarm.kind == TrackAlarmKind::joint_changed) return true;
  return alarm.kind == TrackAlarmKind::sensor_moved &&
         (fault.kind == FaultKind::play || alarm.sensor == static_cast<int>(fault.sensor));
}

double seconds_until_named(const TrackScore& score, const InjectedFault& fault) {
  double first = duration;
  for (const TrackScore::Alarm& alarm : score.alarms)
    if (names(alarm.first, fault)) first = std::min(first, alarm.at);
  return first - fault_begin;
}

bool is_judgement(TrackAlarmKind kind) {
  return kind == TrackAlarmKind::does_not_fit || kind == TrackAlarmKind::sensor_moved ||
         kind == TrackAlarmKind::joint_changed;
}

}  // namespace

std::vector<TrackedDrive> tracked_drives() {
  const std::vector<InjectedFault> faults{
      {},
      {.kind = FaultKind::turned, .sensor = 2, .size = 0.5 * degree, .begin = fault_begin, .end = duration},
      {.kind = FaultKind::play, .sensor = 2, .size = 3e-3, .begin = fault_begin, .end = duration}};
  std::vector<TrackedDrive> drives;
  std::uint64_t seed = 500;
  for (const char* machine : {"excavator-general", "robot6"})
    for (const Base base : {Base::still, Base::rocking}) {
      const SimulatedDrive first =
          simulate_drive({.machine = machine, .base = base, .machine_seed = ++seed, .drive_seed = seed});
      const auto model = identify_drive(first);
      if (!model) continue;
      for (const InjectedFault& fault : faults) {
        SimulatedDrive second = simulate_drive(
            {.machine = machine, .base = base, .duration = duration, .machine_seed = seed, .drive_seed = 1000 + seed});
        inject(fault, second);
        drives.push_back({first, *model, std::move(second), fault});
      }
    }
  return drives;
}

Figures tracking_figures(const std::vector<TrackedDrive>& drives) {
  double worst_joint = 0.0, tool = 0.0, false_alarms = 0.0, log_delay = 0.0, sound = 0.0, faulty = 0.0, nees = 0.0;
  for (const TrackedDrive& drive : drives) {
    const TrackScore score = track(drive.model, &drive.identified, drive.drive);
    if (drive.fault.kind != FaultKind::none) {
      faulty += 1.0, log_delay += std::log(std::max(0.02, seconds_until_named(score, drive.fault)));
      continue;
    }
    sound += 1.0, tool += score.tool_rms;
    double joints = 0.0;
    for (const JointScore& joint : score.joints) {
      if (!joint.is_first) worst_joint = std::max(worst_joint, joint.rms);
      joints += joint.nees / static_cast<double>(score.joints.size());
    }
    nees += joints;
    false_alarms += static_cast<double>(
        std::ranges::count_if(score.alarms, [](const auto& alarm) { return is_judgement(alarm.first.kind); }));
  }
  return {{"joint positions, worst rms [deg]", worst_joint / degree},
          {"tool, mean rms [mm]", 1e3 * tool / sound},
          {"squared error over variance, mean", nees / sound},
          {"false alarms", false_alarms},
          {"until a fault is named, geometric mean [s]", std::exp(log_delay / faulty)}};
}

}  // namespace kinfer::study::thresholds_study
