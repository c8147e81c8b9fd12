// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/inspect/recording_json.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "kinfer/inertial/sensor_grading.hpp"
#include "kinfer/io/evidence/findings_json.hpp"
#include "kinfer/io/text/dump_json.hpp"

namespace kinfer::cli {
namespace {

using nlohmann::ordered_json;

ordered_json logger_json(const InsLogger& logger) {
  ordered_json out{{"name", logger.name}, {"rows", logger.time.size()}};
  if (logger.time.empty()) return out;
  out["begin_s"] = logger.time.front(), out["end_s"] = logger.time.back();
  if (const double period = sample_period(logger.time); period > 0.0) out["rate_hz"] = 1.0 / period;
  out["gaps"] = ordered_json::array();
  for (const auto& gap : gaps(logger.time)) out["gaps"].push_back({{"begin_s", gap.begin}, {"end_s", gap.end}});
  return out;
}

ordered_json sensor_json(const InsRecording& recording, const InsSensor& sensor) {
  const auto time = recording.time(sensor);
  ordered_json out{{"name", sensor.name}, {"logger", recording.loggers[sensor.logger].name}};
  out["accelerometer_hz"] = sample_rate(sensor, time, acceleration_missing);
  out["gyroscope_hz"] = sample_rate(sensor, time, angular_velocity_missing);
  if (sensor.has_magnetometer()) out["magnetometer_hz"] = sample_rate(sensor, time, field_missing);
  out["rests"] = ordered_json::array();
  const std::vector<RestPeriod> rests = rest_periods(sensor, time);
  for (const RestPeriod& rest : rests) out["rests"].push_back({{"begin_s", rest.begin}, {"end_s", rest.end}});
  if (rests.empty()) return out;
  const SensorStatistics found = sensor_statistics(sensor, time, rests);
  out["gravity_error"] = found.gravity_error;
  out["largest_rate"] = found.largest_rate;
  out["largest_acceleration"] = found.largest_acceleration;
  out["grade"] = estimate_sensor_model(found).name;
  return out;
}

}  // namespace

double sample_rate(const InsSensor& sensor, std::span<const double> time, Fault missing) {
  const double span = time.back() - time.front();
  const std::size_t samples = time.size() - count(sensor, missing);
  return span > 0.0 && samples > 1 ? static_cast<double>(samples - 1) / span : 0.0;
}

bool assumes_upward_force(const InsRecording& recording) {
  return std::ranges::none_of(recording.sensors, &InsSensor::has_magnetometer);
}

std::string recording_json(const DiagnosedLogs& logs) {
  ordered_json out{{"kind", "recording"}, {"loggers", ordered_json::array()}, {"sensors", ordered_json::array()}};
  for (const InsLogger& logger : logs.recording.loggers) out["loggers"].push_back(logger_json(logger));
  for (const InsSensor& sensor : logs.recording.sensors) out["sensors"].push_back(sensor_json(logs.recording, sensor));
  out["remarks"] = logs.recording.remarks;
  out["findings"] = ordered_json::parse(format_findings(logs.findings));
  out["assumptions"] = ordered_json::array();
  if (assumes_upward_force(logs.recording)) out["assumptions"].push_back("accelerometer_sign");
  return dump_json(out, 1) + "\n";
}

}  // namespace kinfer::cli
