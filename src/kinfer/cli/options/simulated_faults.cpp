// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/options/simulated_faults.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/io/text/csv.hpp"
#include "kinfer/simulate/log_faults.hpp"

namespace kinfer::cli {
namespace {

struct SensorAndNumber {
  std::size_t sensor = 0;
  double number = 0.0;
};

/// "ins2=50"
template <class Sensors>
Result<SensorAndNumber> parse_sensor_and_number(const std::string& text, const char* option, const Sensors& sensors) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) return error("{} {}: expected SENSOR=NUMBER", option, text);
  const std::string name = text.substr(0, equals), number = text.substr(equals + 1);
  const auto place = std::ranges::find_if(sensors, [&](const auto& sensor) { return sensor.name == name; });
  if (place == sensors.end()) return error("{} {}: no sensor {}", option, text, name);
  const auto value = parse_number(number);
  if (!value || !(*value >= 0.0)) return error("{} {}: expected a non-negative number after =", option, text);
  return SensorAndNumber{static_cast<std::size_t>(place - sensors.begin()), *value};
}

}  // namespace

Result<MachineMotion> with_remount(const Machine& machine, MachineMotion motion, const SimulatedFaults& faults) {
  if (faults.remount.empty()) return motion;
  KINFER_TRY(what, parse_sensor_and_number(faults.remount, "--remount", machine.sensors));
  const auto row = std::ranges::lower_bound(motion.time, what.number) - motion.time.begin();
  const Pose old_T_new{exp_so3(Vec3(0.2, 0.3, 0.1)), Vec3(0.06, 0.0, 0.08)};
  return kinfer::with_remount(std::move(motion), what.sensor, static_cast<std::size_t>(row), old_T_new);
}

Result<InsRecording> with_late_sensor(InsRecording recording, const SimulatedFaults& faults) {
  if (faults.late.empty()) return recording;
  KINFER_TRY(what, parse_sensor_and_number(faults.late, "--late", recording.sensors));
  const double rows = 1e-3 * what.number / median_period(recording.loggers.front().time);
  if (rows >= static_cast<double>(recording.sensors[what.sensor].rows()))
    return error("--late {}: longer than the recording", faults.late);
  return with_delayed_rows(recording, what.sensor, static_cast<std::size_t>(std::round(rows)));
}

InsRecording with_stamp_faults(InsRecording recording, const SimulatedFaults& faults, const Rng& rng) {
  if (faults.packet > 1) recording = with_packets(recording, static_cast<std::size_t>(faults.packet));
  return faults.jitter > 0.0 ? with_stamp_jitter(recording, 1e-3 * faults.jitter, rng) : recording;
}

}  // namespace kinfer::cli
