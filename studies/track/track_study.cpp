// SPDX-License-Identifier: Apache-2.0
// Simulated machines, identified on one drive by default options and tracked on another one; then measured ones.
//   ./dev study track --help
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "studies/studies.hpp"
#include "studies/support/arguments.hpp"
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
  double duration = 120.0, steel = 0.0, judged_from = 0.0, power_up = 0.0;
  InjectedFault fault{};
  bool counts_alarms = false, smooths = false, is_exact = false;
};

const std::map<std::string, Base> bases{{"still", Base::still}, {"rocking", Base::rocking}, {"yawing", Base::yawing}};
const std::map<std::string, Script> scripts{
    {"standard", Script::standard}, {"gentle", Script::gentle}, {"quick", Script::quick}};
const std::map<std::string, FaultKind> faults{{"turned", FaultKind::turned},
                                              {"shifted", FaultKind::shifted},
                                              {"play", FaultKind::play},
                                              {"late", FaultKind::late},
                                              {"lost", FaultKind::lost}};

void print(const std::string& machine, const std::string& grade, int seed, const TrackScore& score) {
  fmt::print("{:<18} {:<10} {:>2}  ", machine, grade, seed);
  for (const JointScore& joint : score.joints) {
    const double unit = joint.is_prismatic ? 1e-3 : degree;
    fmt::print(" {:.3f}{}({:.2f}) {:.3f} {:.1f} {:.0f}%", joint.rms / unit,
               joint.is_prismatic ? "mm"
               : joint.is_first   ? "*"
                                  : "",
               joint.composed_rms / unit, joint.stated / unit, joint.nees, 100.0 * joint.coverage);
  }
  fmt::print("  tool {:.1f} mm, tilt {:.3f} {:.3f}, {:.0f} us", 1e3 * score.tool_rms, score.base_tilt_rms / degree,
             score.stated_base_tilt / degree, 1e6 * score.cpu_per_row);
  for (const auto& alarm : score.alarms)
    fmt::print("; {} {} {} at {:.2f}", name(alarm.first.kind), alarm.first.sensor, alarm.first.joint, alarm.at);
  fmt::print("\n");
  std::fflush(stdout);
}

void run(const Arguments& a) {
  fmt::print("joint: rms [deg] (composed) stated NEES coverage; *: counts from the start; tilt: rms, stated\n");
  for (const std::string& machine : a.machines)
    for (const std::string& grade : a.grades)
      for (int seed = a.first_seed; seed < a.first_seed + a.seeds; ++seed) {
        const auto number = static_cast<std::uint64_t>(seed);
        const SimulatedDrive first = simulate_drive(
            {.machine = machine, .grade = grade, .base = a.base, .machine_seed = number, .drive_seed = number});
        const auto model = a.is_exact ? Result<TrackingModel>(exact_model(first, grade)) : identify_drive(first);
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
                                                .steel = a.steel,
                                                .known_sensors = a.is_exact});
        if (a.power_up > 0.0) change_biases(a.power_up, grade, number, second);
        inject(a.fault, second);
        const SimulatedDrive* zeros = a.is_exact ? nullptr : &first;
        print(machine, grade, seed, track(*model, zeros, second, {.from = a.judged_from}));
        if (a.smooths)
          print("  smoothed", grade, seed,
                track(*model, zeros, second, {kinfer::track::Estimator::smoother, a.judged_from}));
      }
}

}  // namespace
}  // namespace kinfer::study::track_study

int kinfer::study::run_track(int argc, char** argv) {
  const char* data = std::getenv("KINFER_DATA");
  const std::string folder = data ? data : "";
  using namespace track_study;
  Arguments arguments;
  std::string measured;
  ArgumentParser app("Simulated machines tracked on another drive than they were identified on");
  app.add_option("--machines", arguments.machines, "As of simulate, joined by commas")->delimiter(',');
  app.add_option("--grades", arguments.grades, "Of the sensors, joined by commas")->delimiter(',');
  app.add_option("--base", arguments.base)->transform(CLI::CheckedTransformer(bases));
  app.add_option("--script", arguments.script, "Of the drive")->transform(CLI::CheckedTransformer(scripts));
  app.add_option("--first", arguments.first_seed, "First seed");
  app.add_option("--seeds", arguments.seeds, "How many");
  app.add_option("--duration", arguments.duration, "Of a drive [s]");
  app.add_option("--judge-from", arguments.judged_from, "Errors before this time of the drive do not count [s]");
  app.add_option("--steel", arguments.steel, "Field of moving steel [µT]");
  app.add_option("--power-up", arguments.power_up,
                 "Biases have changed since the identification, by so much of the grade's standard deviation");
  app.add_option("--smooth", arguments.smooths, "on: the smoother's row below the filter's");
  app.add_option("--exact", arguments.is_exact,
                 "on: the machine's own geometry and sensors without biases and scale errors, the best there can be");
  app.add_option("--fault", arguments.fault.kind)->transform(CLI::CheckedTransformer(faults));
  app.add_option("--sensor", arguments.fault.sensor, "That has the fault");
  app.add_option("--size", arguments.fault.size, "Of the fault [rad], [m] or [s]");
  app.add_option("--from", arguments.fault.begin, "Of the fault [s]");
  app.add_option("--to", arguments.fault.end, "Of the fault [s]");
  app.add_option("--alarms", arguments.counts_alarms, "on: count alarms instead");
  app.add_option("--measured", measured, "These measured machines alone: diodem, rigid, kuka or ur5");
  if (const auto code = app.exit_code(argc, argv)) return *code;
  if (!measured.empty()) {
    track_measured(folder, measured);
    return 0;
  }
  if (arguments.counts_alarms) {
    study_alarms({.machines = arguments.machines,
                  .grades = arguments.grades,
                  .first_seed = arguments.first_seed,
                  .seeds = arguments.seeds,
                  .duration = arguments.duration});
    return 0;
  }
  run(arguments);
  if (argc == 1) track_measured(folder, {});
  return 0;
}
