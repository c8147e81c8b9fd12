// SPDX-License-Identifier: Apache-2.0
// Simulated machines, identified on one drive by default options and tracked on another one; then measured ones.
// `--smooth on` prints the smoother's row below the filter's; `--measured diodem|kuka|ur5` runs these alone; `--alarms
// on` counts alarms instead (with --machines, --grades,
// --first, --seeds, --duration).
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <numbers>
#include <string_view>

#include "studies/studies.hpp"
#include "studies/track/alarms.hpp"
#include "studies/track/measured.hpp"
#include "studies/track/scores.hpp"

namespace kinfer::study::track_study {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

struct Arguments {
  std::vector<std::string> machines{"excavator-general", "robot6"}, grades{"industrial", "consumer"};
  Base base = Base::still;
  Script script = Script::standard;
  int first_seed = 1, seeds = 1;
  double duration = 120.0, steel = 0.0;
  InjectedFault fault{};
  bool counts_alarms = false, smooths = false;
};

std::vector<std::string> split(std::string_view text) {
  std::vector<std::string> parts;
  for (;;) {
    const auto comma = text.find(',');
    parts.emplace_back(text.substr(0, comma));
    if (comma == std::string_view::npos) return parts;
    text.remove_prefix(comma + 1);
  }
}

Arguments parse(int count, char** values) {
  Arguments a;
  for (int i = 1; i + 1 < count; i += 2) {
    const std::string_view key = values[i], value = values[i + 1];
    const double number = std::atof(values[i + 1]);
    if (key == "--machines") a.machines = split(value);
    if (key == "--grades") a.grades = split(value);
    if (key == "--base") a.base = value == "rocking" ? Base::rocking : value == "yawing" ? Base::yawing : Base::still;
    if (key == "--script")
      a.script = value == "gentle" ? Script::gentle : value == "quick" ? Script::quick : Script::standard;
    if (key == "--seeds") a.seeds = static_cast<int>(number);
    if (key == "--first") a.first_seed = static_cast<int>(number);
    if (key == "--duration") a.duration = number;
    if (key == "--steel") a.steel = number;
    if (key == "--smooth") a.smooths = value == "on";
    if (key == "--alarms") a.counts_alarms = value == "on";
    if (key == "--fault")
      a.fault.kind = value == "turned"    ? FaultKind::turned
                     : value == "shifted" ? FaultKind::shifted
                     : value == "play"    ? FaultKind::play
                     : value == "late"    ? FaultKind::late
                                          : FaultKind::lost;
    if (key == "--sensor") a.fault.sensor = static_cast<std::size_t>(number);
    if (key == "--size") a.fault.size = number;
    if (key == "--from") a.fault.begin = number;
    if (key == "--to") a.fault.end = number;
  }
  return a;
}

void print(const std::string& machine, const std::string& grade, int seed, const TrackScore& score) {
  fmt::print("{:<18} {:<10} {:>2}  ", machine, grade, seed);
  for (const JointScore& joint : score.joints) {
    const double unit = joint.is_prismatic ? 1e-3 : degree;
    fmt::print(" {:.3f}{}({:.2f}) {:.1f} {:.0f}%", joint.rms / unit,
               joint.is_prismatic ? "mm"
               : joint.is_first   ? "*"
                                  : "",
               joint.composed_rms / unit, joint.nees, 100.0 * joint.coverage);
  }
  fmt::print("  tool {:.1f} mm, tilt {:.3f}, {:.0f} us", 1e3 * score.tool_rms, score.base_tilt_rms / degree,
             1e6 * score.cpu_per_row);
  for (const auto& alarm : score.alarms)
    fmt::print("; {} {} {} at {:.2f}", name(alarm.first.kind), alarm.first.sensor, alarm.first.joint, alarm.at);
  fmt::print("\n");
  std::fflush(stdout);
}

void run(const Arguments& a) {
  fmt::print("joint: rms [deg] (composed) NEES coverage; *: counts from the start\n");
  for (const std::string& machine : a.machines)
    for (const std::string& grade : a.grades)
      for (int seed = a.first_seed; seed < a.first_seed + a.seeds; ++seed) {
        const auto number = static_cast<std::uint64_t>(seed);
        const SimulatedDrive first = simulate_drive(
            {.machine = machine, .grade = grade, .base = a.base, .machine_seed = number, .drive_seed = number});
        const auto model = identify_drive(first);
        if (!model) {
          fmt::print("{} {} {}: {}\n", machine, grade, seed, model.error().what);
          continue;
        }
        SimulatedDrive second = simulate_drive({.machine = machine,
                                                .grade = grade,
                                                .base = a.base,
                                                .script = a.script,
                                                .duration = a.duration,
                                                .machine_seed = number,
                                                .drive_seed = 1000 + number,
                                                .steel = a.steel});
        inject(a.fault, second);
        print(machine, grade, seed, track(*model, first, second));
        if (a.smooths)
          print("  smoothed", grade, seed, track(*model, first, second, kinfer::track::Estimator::smoother));
      }
}

}  // namespace
}  // namespace kinfer::study::track_study

int kinfer::study::run_track(int argc, char** argv) {
  const char* data = std::getenv("KINFER_DATA");
  const std::string folder = data ? data : "";
  if (argc == 3 && std::string_view(argv[1]) == "--measured") {
    track_study::track_measured(folder, argv[2]);
    return 0;
  }
  const track_study::Arguments arguments = track_study::parse(argc, argv);
  if (arguments.counts_alarms) {
    track_study::study_alarms({.machines = arguments.machines,
                               .grades = arguments.grades,
                               .first_seed = arguments.first_seed,
                               .seeds = arguments.seeds,
                               .duration = arguments.duration});
    return 0;
  }
  track_study::run(arguments);
  if (argc == 1) track_study::track_measured(folder, {});
  return 0;
}
