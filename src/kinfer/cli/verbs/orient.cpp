// SPDX-License-Identifier: Apache-2.0
// kinfer orient: orientation of each sensor of an INS recording, row by row.
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "kinfer/cli/verb_list.hpp"
#include "kinfer/inertial/filters/orientation.hpp"
#include "kinfer/io/recording/ins_csv.hpp"
#include "kinfer/io/recording/orientation_csv.hpp"

namespace kinfer::cli {
namespace {

struct OrientArguments {
  CommonOptions common;
  std::vector<std::string> logs;
  std::string out, filter = "kinfer", sensor, magnetometer = "auto";
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

Result<void> expect_usable(const InsRecording& recording, const std::vector<std::size_t>& chosen) {
  for (const std::size_t i : chosen) {
    const InsSensor& sensor = recording.sensors[i];
    const bool has_any =
        std::ranges::any_of(sensor.faults, [](std::uint8_t bits) { return !(bits & acceleration_missing); });
    if (!has_any)
      return error(
          "{}: sensor {}: no row has a specific force, so its orientation is unknown; select another one with --sensor",
          recording.loggers[sensor.logger].name, sensor.name);
  }
  return {};
}

struct SensorSummary {
  std::string name;
  std::size_t rows = 0;
  bool magnetometer = false;
  double rest_seconds = 0.0;
};

nlohmann::ordered_json as_json(const OrientArguments& options, const std::vector<SensorSummary>& sensors) {
  nlohmann::ordered_json out;
  out["filter"] = options.filter;
  for (const SensorSummary& s : sensors)
    out["sensors"].push_back(
        {{"name", s.name}, {"rows", s.rows}, {"magnetometer", s.magnetometer}, {"rest_s", s.rest_seconds}});
  return out;
}

void print_summary(const OrientArguments& options, const std::vector<SensorSummary>& sensors) {
  fmt::print("{}: filter {}\n", options.out, options.filter);
  for (const SensorSummary& s : sensors) {
    fmt::print("  {:<12} {:>8} rows, {}, {:.1f} s of rest\n", s.name, s.rows,
               s.magnetometer ? "heading from the magnetometer" : "no magnetometer: heading is relative to the start",
               s.rest_seconds);
    if (s.rest_seconds <= 0.0)
      fmt::print("  ! {}: no rest found: the gyro bias is known from the motion alone\n", s.name);
  }
}

int run(const OrientArguments& options) {
  const auto filter = filter_named(options.filter);
  if (!filter) return fail({fmt::format("--filter {}: no such filter, known are {}", options.filter, filter_names)});
  const FilterOptions how = options.magnetometer == "off" ? without_magnetometer(*filter) : *filter;
  const std::vector<std::filesystem::path> paths(options.logs.begin(), options.logs.end());
  const auto recording = read_ins_csv(paths);
  if (!recording) return fail(recording.error());
  const auto chosen = chosen_sensors(*recording, options.sensor);
  if (!chosen) return fail(chosen.error());
  if (auto usable = expect_usable(*recording, *chosen); !usable) return fail(usable.error());
  if (!options.common.quiet)
    for (const std::string& remark : recording->remarks) fmt::print(stderr, "kinfer: {}\n", remark);

  std::vector<SensorOrientations> found;
  std::vector<SensorSummary> summary;
  for (const std::size_t i : *chosen) {  // sequentially: the smoother needs memory for one sensor only
    const InsSensor& sensor = recording->sensors[i];
    const auto time = recording->time(sensor);
    found.push_back({i, estimate_orientations(sensor, time, how)});
    summary.push_back({sensor.name, time.size(), sensor.has_magnetometer() && options.magnetometer != "off",
                       bias_at_rest(rest_periods(sensor, time)).seconds});
  }
  if (auto done = write_orientation_csv(options.out, *recording, found); !done) return fail(done.error());
  if (options.common.json)
    fmt::print("{}\n", as_json(options, summary).dump());
  else if (!options.common.quiet)
    print_summary(options, summary);
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
  add_text(
      *verb, "--filter", options->filter,
      "kinfer: online; kinfer-offline: smoothed, each row knows what comes after it; paper: the 12-state filter of "
      "Péntek et al. 2021",
      Requirement::optional, "NAME");
  add_text(*verb, "--sensor", options->sensor, "Only this sensor (default: all)", Requirement::optional, "NAME");
  add_choice(*verb, "--magnetometer", options->magnetometer, {"auto", "off"},
             "auto: heading from the magnetometer where there is one; off: never");
  add_common_options(*verb, options->common);
  return {verb, [options] { return run(*options); }};
}

}  // namespace kinfer::cli
