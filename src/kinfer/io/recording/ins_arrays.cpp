// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/recording/ins_arrays.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/measurement/ins/ins_screening.hpp"
#include "kinfer/measurement/ins/unit_check.hpp"

namespace kinfer {
namespace {

TriadColumns triad_columns(std::span<const double> rows) {
  TriadColumns columns;
  for (std::size_t k = 0; k < 3; ++k) {
    columns.axis[k].reserve(rows.size() / 3);
    for (std::size_t i = k; i < rows.size(); i += 3) columns.axis[k].push_back(static_cast<float>(rows[i]));
  }
  return columns;
}

Result<void> expect_increasing(const InsArrays& arrays) {
  for (std::size_t i = 0; i < arrays.time.size(); ++i) {
    if (!std::isfinite(arrays.time[i])) return error("{}: t[{}] is not finite", arrays.sensor, i);
    if (i > 0 && arrays.time[i] <= arrays.time[i - 1])
      return error("{}: t[{}] = {} is not after t[{}] = {}", arrays.sensor, i, arrays.time[i], i - 1,
                   arrays.time[i - 1]);
  }
  return {};
}

/// Index of the logger with these instants, added where there is none.
std::size_t logger_of(std::span<const double> time, InsRecording& recording) {
  for (std::size_t i = 0; i < recording.loggers.size(); ++i)
    if (std::ranges::equal(recording.loggers[i].time, time)) return i;
  recording.loggers.push_back({.name = fmt::format("array {}", recording.loggers.size() + 1),
                               .time = std::vector<double>(time.begin(), time.end())});
  return recording.loggers.size() - 1;
}

}  // namespace

Result<void> append_ins_arrays(const InsArrays& arrays, InsRecording& recording) {
  if (arrays.time.empty()) return error("{}: there are no rows", arrays.sensor);
  if (auto increasing = expect_increasing(arrays); !increasing) return increasing;
  for (const InsSensor& other : recording.sensors)
    if (other.name == arrays.sensor) return error("{}: the sensor is there twice", arrays.sensor);
  InsSensor sensor;
  sensor.name = arrays.sensor;
  sensor.acceleration = triad_columns(arrays.acceleration);
  sensor.angular_velocity = triad_columns(arrays.angular_velocity);
  if (!arrays.field.empty()) sensor.field = triad_columns(arrays.field);
  sensor.logger = logger_of(arrays.time, recording);
  flag_faults(sensor);
  for (const UnitWarning& doubt : check_units(sensor, true)) {
    if (doubt.fatal) return error("{}", doubt.sentence);
    recording.remarks.push_back(doubt.sentence);
    sensor.field = {};
  }
  recording.sensors.push_back(std::move(sensor));
  return {};
}

}  // namespace kinfer
