// SPDX-License-Identifier: Apache-2.0
// kinfer forecast: expected accuracy of each joint, from a short recording or a simulated drive.
#include "kinfer/identify/findings/forecast.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "kinfer/cli/options/drive_choices.hpp"
#include "kinfer/cli/options/robot_option.hpp"
#include "kinfer/cli/parts/ins_logs.hpp"
#include "kinfer/cli/parts/terminal.hpp"
#include "kinfer/cli/verb_list.hpp"
#include "kinfer/identify/pipeline.hpp"
#include "kinfer/io/robot/toml/robot_toml.hpp"
#include "kinfer/io/text/dump_json.hpp"
#include "kinfer/simulate/ins_recording.hpp"
#include "kinfer/simulate/machine_from_chain.hpp"
#include "kinfer/simulate/prescribed_motion.hpp"
#include "kinfer/words/identification/forecast.hpp"

namespace kinfer::cli {
namespace {

struct ForecastArguments {
  CommonOptions common;
  std::vector<std::string> logs, topics;
  std::string columns, chain, drive = "standard", grade = "industrial";
  double duration = 0.0, line = 5.0, direction = 3.0;  // s, mm, mrad
};

AccuracyTarget target_of(const ForecastArguments& options) {
  return {1e-3 * options.line, 1e-3 * options.direction};
}

/// Simulates the drive with an identified chain.
Result<InsRecording> simulate_drive(const ForecastArguments& options) {
  KINFER_TRY(robot, read_robot_toml(options.chain));
  const auto machine = make_machine(robot.chain);
  if (!machine) return error("{}: {}", options.chain, machine.error().what);
  KINFER_TRY(grade, read_grade(options.grade));
  const Rng rng(options.common.seed);
  KINFER_TRY(drive, make_drive(*machine, {.script = drive_scripts.at(options.drive), .duration = options.duration},
                               rng.stream(1)));
  constexpr double sampling_rate = 200.0;  // [Hz]
  return simulate_recording(*machine, prescribed_motion(*machine, drive, sampling_rate), grade, {}, rng.stream(2));
}

Result<std::vector<JointForecast>> forecast_of(const ForecastArguments& options) {
  if (options.logs.empty() == options.chain.empty())
    return error("expected either recordings, or --chain with a chain.toml written by identify");
  auto recording = options.chain.empty()
                       ? read_ins_logs({options.logs, options.columns, options.topics}, options.common)
                       : simulate_drive(options);
  if (!recording) return forward_error(recording.error());
  identify::IdentifyOptions how;
  how.threads = options.common.threads;
  ProgressLine progress(options.common);
  KINFER_TRY(found, identify::identify_machine(*recording, how, Rng(options.common.seed), progress.observer()));
  return identify::forecast(found.joints, target_of(options));
}

std::string number_text(double value, int decimals) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, decimals) : "unknown";
}

std::string factor_text(const JointForecast& f, double factor) {
  return f.is_sufficient || !is_determined(f) ? "-" : fmt::format("{:.1f}", factor);
}

void print_table(const std::vector<JointForecast>& joints, const ForecastArguments& options) {
  print_text("Expected of {}: {}.\n\n", options.chain.empty() ? "this recording" : "the " + options.drive + " drive",
             words::forecast_text(joints, target_of(options)));
  print_text("{:<16} {:>12} {:>16} {:>8} {:>18} {:>12}\n", "joint", "sd line [mm]", "sd axis [mrad]", "enough",
             "acceleration x", "or time x");
  for (const JointForecast& f : joints)
    print_text("{:<16} {:>12} {:>16} {:>8} {:>18} {:>12}\n", f.joint, number_text(1e3 * f.line_sd, 2),
               number_text(1e3 * f.direction_sd, 2), f.is_sufficient ? "yes" : "no",
               factor_text(f, f.acceleration_factor), factor_text(f, f.time_factor));
}

void print_json(const std::vector<JointForecast>& joints, const ForecastArguments& options) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const JointForecast& f : joints)
    list.push_back({{"joint", f.joint},
                    {"line_sd_m", f.line_sd},
                    {"direction_sd_rad", f.direction_sd},
                    {"enough", f.is_sufficient},
                    {"acceleration_factor", f.acceleration_factor},
                    {"time_factor", f.time_factor}});
  const nlohmann::ordered_json all{{"verdict", words::forecast_text(joints, target_of(options))}, {"joints", list}};
  print_data(dump_json(all) + "\n");
}

int run(const ForecastArguments& options) {
  const auto joints = forecast_of(options);
  if (!joints) return fail(joints.error());
  if (options.common.json)
    print_json(*joints, options);
  else
    print_table(*joints, options);
  return exit_done;
}

}  // namespace

Verb add_forecast(CLI::App& app) {
  CLI::App* verb = add_command(
      app, "forecast", "How accurately a drive determines each joint, and how much more excitation is needed",
      "From a short recording, or by rehearsing a drive with an earlier chain.\nExamples:\n"
      "  kinfer forecast short.csv\n"
      "  kinfer forecast --chain excavator/chain.toml --drive gentle --duration 90 --grade industrial");
  auto options = std::make_shared<ForecastArguments>();
  add_texts(*verb, "logs", options->logs, "INS recordings", Requirement::optional, "CSV");
  add_model_file(*verb, "--chain", options->chain, "chain.toml of an earlier identification, or the folder it is in",
                 Requirement::optional, "TOML");
  std::vector<std::string> drives;
  for (const auto& [name, script] : drive_scripts) drives.push_back(name);
  add_choice(*verb, "--drive", options->drive, drives, "Drive to rehearse (see kinfer simulate --help)");
  add_number(*verb, "--duration", options->duration, 0.0, 3600.0, "Length of the drive [s]; 0: its own");
  add_text(*verb, "--grade", options->grade, "Sensors of the rehearsal: noise, industrial, consumer or a TOML",
           Requirement::optional, "GRADE");
  add_number(*verb, "--line", options->line, 0.01, 1000.0, "Wanted of every axis line, in 95 of 100 cases [mm]");
  add_number(*verb, "--direction", options->direction, 0.01, 1000.0,
             "Wanted of every axis direction, in 95 of 100 cases [mrad]");
  add_log_options(*verb, options->columns, options->topics);
  add_common_options(*verb, options->common);
  return {verb, [options] { return run(*options); }};
}

}  // namespace kinfer::cli
