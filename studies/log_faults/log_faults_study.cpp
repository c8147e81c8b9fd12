// SPDX-License-Identifier: Apache-2.0
// Faults of logs: how often each is named, with no other kind of finding beside it; false findings on sound logs;
// findings on the logs that are given.
//
//   ./dev study log_faults --help
//
// Machines 1, 3, 5 with odd seeds and 2, 4 with even ones were looked at while thresholds were chosen; the others are
// told apart ("other").
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <map>

#include "kinfer/identify/diagnosis/diagnosis.hpp"
#include "kinfer/io/recording/ins_csv.hpp"
#include "kinfer/simulate/ins_recording.hpp"
#include "kinfer/simulate/mujoco_world.hpp"
#include "kinfer/words/findings/findings.hpp"
#include "studies/log_faults/faults.hpp"
#include "studies/studies.hpp"
#include "studies/support/arguments.hpp"
#include "studies/support/corpus.hpp"

namespace kinfer::study::log_faults_study {
namespace {

struct Options {
  int seeds = 4, sound = 400, first_seed = 1;
  bool verbose = false;
  std::string only;
  std::vector<std::string> logs;
};

InsRecording sound_recording(const std::string& machine, std::uint64_t seed) {
  constexpr const char* grades[] = {"industrial", "consumer"};
  constexpr double sampling_rate = 100.0;  // [Hz]
  const Rng rng(seed);
  const auto world =
      MujocoWorld::load(machine_mjcf(machine, {.mounting = Mounting::arbitrary}, rng.stream(1)).value()).value();
  const Drive drive = make_drive(world.machine(), {}, rng.stream(2)).value();
  return simulate_recording(world.machine(), world.prescribe(drive, sampling_rate),
                            sensor_grade(grades[seed % 2]).value(), {}, rng.stream(3));
}

/// The fault is named, and nothing else is.
bool is_named(const LogFault& fault, const Result<identify::LogDiagnosis>& diagnosis) {
  if (fault.kinds.empty() || !diagnosis) return fault.kinds.empty() && !diagnosis;
  return !diagnosis->findings.empty() && std::ranges::all_of(diagnosis->findings, [&](const Finding& f) {
    return std::ranges::find(fault.kinds, f.kind) != fault.kinds.end();
  });
}

void print_findings(const std::string& log, const Result<identify::LogDiagnosis>& diagnosis) {
  if (!diagnosis) fmt::print("{}: refused: {}\n", log, diagnosis.error().what);
  if (diagnosis)
    for (const Finding& f : diagnosis->findings)
      fmt::print("{}: {}: {}{}\n", log, name(f.kind), words::sentence(f),
                 f.values.has("log_likelihood_gain")
                     ? fmt::format(" ({:.0f} nats)", f.values.number("log_likelihood_gain"))
                     : "");
}

struct Count {
  int named = 0, all = 0;
};

void study_faults(const Options& options) {
  const auto machines = machine_names();
  std::map<std::string, std::array<Count, 2>> counts;
  for (std::size_t m = 0; m < machines.size(); ++m)
    for (int k = 0; k < options.seeds; ++k) {
      const auto seed = static_cast<std::uint64_t>(options.first_seed + k);
      const InsRecording sound = sound_recording(machines[m], 100 * seed + m);
      const bool is_other = (m + seed) % 2 == 0;
      for (const LogFault& fault : log_faults()) {
        if (!options.only.empty() && fault.name.find(options.only) == std::string::npos) continue;
        InsRecording faulty = sound;
        fault.inject(faulty, Rng(seed).stream(m).stream(7));
        const auto diagnosis = identify::diagnose_log(faulty, 1);
        Count& count = counts[fault.name][is_other ? 1 : 0];
        ++count.all;
        if (is_named(fault, diagnosis)) ++count.named;
        if (options.verbose) {
          fmt::print("{} {} of {} seed {}\n", is_named(fault, diagnosis) ? "named" : "missed", fault.name, machines[m],
                     seed);
          print_findings("  found", diagnosis);
        }
      }
    }
  fmt::print("{:<36} {:>10} {:>10}\n", "fault", "chosen on", "other");
  for (const LogFault& fault : log_faults())
    if (const auto c = counts.find(fault.name); c != counts.end())
      fmt::print("{:<36} {:>4} of {:>2} {:>4} of {:>2}\n", fault.name, c->second[0].named, c->second[0].all,
                 c->second[1].named, c->second[1].all);
}

void study_sound_logs(const Options& options) {
  int with_findings = 0;
  for (int i = 0; i < options.sound; ++i) {
    const JudgedLog log = sound_log(static_cast<std::uint64_t>(options.first_seed + i), static_cast<std::size_t>(i));
    const auto diagnosis = identify::diagnose_log(log.recording, 1);
    if (diagnosis && diagnosis->findings.empty()) continue;
    ++with_findings;
    print_findings(log.name, diagnosis);
  }
  if (options.sound > 0) fmt::print("sound simulated logs with findings: {} of {}\n", with_findings, options.sound);
}

void study_files(const Options& options) {
  for (const std::string& path : options.logs) {
    const auto recording = read_ins_csv(path);
    if (!recording) {
      fmt::print("{}: {}\n", path, recording.error().what);
      continue;
    }
    const auto diagnosis = identify::diagnose_log(*recording, 1);
    if (diagnosis && diagnosis->findings.empty()) fmt::print("{}: nothing\n", path);
    print_findings(path, diagnosis);
  }
}

}  // namespace
}  // namespace kinfer::study::log_faults_study

int kinfer::study::run_log_faults(int argc, char** argv) {
  log_faults_study::Options options;
  ArgumentParser app("Faults of logs: what is found, and what is found in sound logs");
  app.add_option("--seeds", options.seeds, "Logs of each fault");
  app.add_option("--sound", options.sound, "Sound logs");
  app.add_option("--first-seed", options.first_seed, "Of the logs");
  app.add_option("--only", options.only, "One fault alone");
  app.add_flag("--verbose", options.verbose, "Findings of every log");
  app.add_option("LOG", options.logs, "INS logs to look at instead");
  if (const auto code = app.exit_code(argc, argv)) return *code;
  if (options.logs.empty()) log_faults_study::study_faults(options);
  if (options.logs.empty()) log_faults_study::study_sound_logs(options);
  log_faults_study::study_files(options);
  return 0;
}
