// SPDX-License-Identifier: Apache-2.0
// kinfer orient: orientation of each sensor of an INS recording, row by row.
#include <memory>
#include <nlohmann/json.hpp>

#include "kinfer/cli/parts/ins_logs.hpp"
#include "kinfer/cli/parts/terminal.hpp"
#include "kinfer/cli/verb_list.hpp"
#include "kinfer/inertial/sensor_orientations.hpp"
#include "kinfer/io/recording/orientation_csv.hpp"
#include "kinfer/io/text/dump_json.hpp"
#include "kinfer/words/findings/findings.hpp"

namespace kinfer::cli {
namespace {

struct OrientArguments {
  CommonOptions common;
  std::vector<std::string> logs, topics;
  std::string out, filter = "kinfer", sensor, columns, magnetometer = "auto";
};

/// Indices of the selected sensors: all, or the one named.
Result<std::vector<std::size_t>> chosen_sensors(const InsRecording& recording, const std::string& name) {
  std::vector<std::size_t> chosen;
  std::string known;
  for (std::size_t i = 0; i < recording.sensors.size(); ++i) {
    known += (known.empty() ? "" : ", ") + recording.sensors[i].name;
    if (name.empty() || recording.sensors[i].name == name) chosen.push_back(i);
  }
  if (chosen.empty()) return error("--sensor {}: no such sensor; the recording has {}", name, known);
  return chosen;
}

nlohmann::ordered_json as_json(const OrientArguments& options, const InsRecording& recording,
                               const std::vector<SensorOrientations>& orientations) {
  nlohmann::ordered_json out;
  out["filter"] = options.filter;
  for (const SensorOrientations& o : orientations)
    out["sensors"].push_back({{"name", recording.sensors[o.sensor].name},
                              {"rows", o.world_q_sensor.size()},
                              {"magnetometer", o.heading_is_north},
                              {"rest_s", o.rest_seconds}});
  return out;
}

void print_summary(const OrientArguments& options, const InsRecording& recording,
                   const std::vector<SensorOrientations>& orientations) {
  print_text("{}: filter {}\n", options.out, options.filter);
  for (const SensorOrientations& o : orientations) {
    const std::string& name = recording.sensors[o.sensor].name;
    print_text(
        "  {:<12} {:>8} rows, {}, {:.1f} s of rest\n", name, o.world_q_sensor.size(),
        o.heading_is_north ? "heading from the magnetometer" : "no magnetometer: heading is relative to the start",
        o.rest_seconds);
    if (o.rest_seconds <= 0.0)
      print_text("  ! {}: no rest found: the gyro bias is known from the motion alone\n", name);
  }
}

int run(const OrientArguments& options) {
  std::vector<std::string> inputs = options.logs;
  inputs.push_back(options.columns);
  if (auto other = expect_other_file(options.out, inputs); !other) return fail(other.error());
  const auto filter = filter_named(options.filter);
  if (!filter) return fail({fmt::format("--filter {}: no such filter, known are {}", options.filter, filter_names())});
  const FilterOptions how = options.magnetometer == "off" ? without_magnetometer(*filter) : *filter;
  const auto logs = read_diagnosed_logs({options.logs, options.columns, options.topics}, options.common);
  if (!logs) return fail(logs.error());
  const InsRecording* recording = &logs->recording;
  const auto chosen = chosen_sensors(*recording, options.sensor);
  if (!chosen) return fail(chosen.error());
  const auto orientations = estimate_orientations(*recording, *chosen, how);
  if (!orientations) return fail(orientations.error());
  if (!options.common.quiet)
    for (const Finding& f : logs->findings) print_message("kinfer: {}\n", words::sentence(f));
  if (!options.common.quiet)
    for (const std::string& remark : recording->remarks) print_message("kinfer: {}\n", remark);
  if (auto done = write_orientation_csv(options.out, *recording, *orientations); !done) return fail(done.error());
  if (options.common.json)
    print_data(dump_json(as_json(options, *recording, *orientations)) + "\n");
  else if (!options.common.quiet)
    print_summary(options, *recording, *orientations);
  return exit_done;
}

}  // namespace

Verb add_orient(CLI::App& app) {
  CLI::App* verb =
      add_command(app, "orient", "Orientation of each sensor of an INS recording, row by row",
                  "World: x east, y magnetic north, z up. Without magnetometer heading is relative to the start.\n"
                  "Example:\n  kinfer orient imu.csv -o orientation.csv --filter kinfer-offline");
  auto options = std::make_shared<OrientArguments>();
  add_texts(*verb, "logs", options->logs, "INS recordings, one a logger", Requirement::required, "CSV");
  add_text(*verb, "-o,--out", options->out,
           "Where to write t, SENSOR_qw, SENSOR_qx, SENSOR_qy, SENSOR_qz (sensor to world)", Requirement::required,
           "CSV");
  add_text(*verb, "--filter", options->filter, filter_help(), Requirement::optional, "NAME");
  add_text(*verb, "--sensor", options->sensor, "Only this sensor (default: all)", Requirement::optional, "NAME");
  add_choice(*verb, "--magnetometer", options->magnetometer, {"auto", "off"},
             "auto: heading from the magnetometer where there is one; off: never");
  add_log_options(*verb, options->columns, options->topics);
  add_common_options(*verb, options->common);
  return {verb, [options] { return run(*options); }};
}

}  // namespace kinfer::cli
