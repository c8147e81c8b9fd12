// SPDX-License-Identifier: Apache-2.0
#include "studies/track/alarms.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "kinfer/base/rng.hpp"
#include "kinfer/identify/diagnosis/mended_log.hpp"
#include "studies/track/scores.hpp"

namespace kinfer::study::track_study {
namespace {

constexpr double fault_begins = 20.0;                                  // [s]
constexpr double turned_by = 0.0087, play_of = 0.003, late_by = 0.02;  // [rad], [m], [s]

bool is_of_fit(const TrackAlarm& alarm) {
  return alarm.kind <= TrackAlarmKind::joint_changed || alarm.kind == TrackAlarmKind::sensor_late;
}

std::string alarms_of(const TrackScore& score, double since) {
  std::string text;
  for (const TrackScore::Alarm& alarm : score.alarms)
    if (is_of_fit(alarm.first))
      text += fmt::format("  {} {} {:+.2f} s", name(alarm.first.kind), std::max(alarm.first.sensor, alarm.first.joint),
                          alarm.at - since);
  return text.empty() ? "  none" : text;
}

void print_row(const std::string& what, const std::string& alarms) {
  fmt::print("  {:<28}{}\n", what, alarms);
  std::fflush(stdout);
}

/// Sensors on the same segments, mounted in any way: what another machine of the type has.
SimulatedDrive remounted(SimulatedDrive drive) {
  Rng rng(7);
  for (InsSensor& sensor : drive.recording.sensors) {
    const double w = rng.normal(), x = rng.normal(), y = rng.normal(), z = rng.normal();
    const Mat3 turn = Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix();
    identify::transform(sensor.acceleration, 1.0, turn), identify::transform(sensor.angular_velocity, 1.0, turn);
  }
  return drive;
}

void study_machine(const AlarmStudy& study, DriveSetup setup) {
  fmt::print("{} {} {}\n", setup.machine, setup.grade, setup.machine_seed);
  const SimulatedDrive identified = simulate_drive(setup);
  const auto model = identify_drive(identified);
  if (!model) return print_row("not identified", model.error().what);
  setup.duration = study.duration;
  setup.drive_seed += 1000;
  for (const auto& [script, label] :
       {std::pair{Script::standard, "standard"}, {Script::quick, "quick"}, {Script::gentle, "gentle"}}) {
    setup.script = script;
    print_row(label, alarms_of(track(*model, &identified, simulate_drive(setup)), 0.0));
  }
  setup.script = Script::standard;
  const SimulatedDrive healthy = simulate_drive(setup);
  for (std::size_t sensor = 1; sensor + 1 < healthy.recording.sensors.size(); ++sensor)
    for (const auto& [kind, size, label] : {std::tuple{FaultKind::turned, turned_by, "turned by 0.5 degrees"},
                                            {FaultKind::play, play_of, "3 mm of play"},
                                            {FaultKind::late, late_by, "20 ms late"}}) {
      SimulatedDrive faulty = healthy;
      inject({.kind = kind, .sensor = sensor, .size = size, .begin = fault_begins, .end = 1e9}, faulty);
      print_row(fmt::format("sensor {} {}", sensor, label),
                alarms_of(track(*model, &identified, faulty), fault_begins));
    }
  setup.machine_seed += 1;
  print_row("another machine's log", alarms_of(track(*model, &identified, remounted(simulate_drive(setup))), 0.0));
}

void study_rocking(const AlarmStudy& study, DriveSetup setup) {
  setup.base = Base::rocking;
  const SimulatedDrive identified = simulate_drive(setup);
  const auto model = identify_drive(identified);
  if (!model) return print_row("rocking, not identified", model.error().what);
  setup.duration = study.duration;
  setup.drive_seed += 1000;
  print_row("rocking", alarms_of(track(*model, &identified, simulate_drive(setup)), 0.0));
}

}  // namespace

void study_alarms(const AlarmStudy& study) {
  fmt::print("alarms, with their sensor and their time; of faults since they began\n");
  for (const std::string& machine : study.machines)
    for (const std::string& grade : study.grades)
      for (int seed = study.first_seed; seed < study.first_seed + study.seeds; ++seed) {
        const auto number = static_cast<std::uint64_t>(seed);
        const DriveSetup setup{.machine = machine, .grade = grade, .machine_seed = number, .drive_seed = number};
        study_machine(study, setup);
        study_rocking(study, setup);
      }
}

}  // namespace kinfer::study::track_study
