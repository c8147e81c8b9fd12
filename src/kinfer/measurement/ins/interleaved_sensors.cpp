// SPDX-License-Identifier: Apache-2.0
#include "kinfer/measurement/ins/interleaved_sensors.hpp"

#include <algorithm>

namespace kinfer {
namespace {

/// Whether a sensor has a sample in each row.
std::vector<bool> sampled_rows(const InsSensor& sensor) {
  std::vector<bool> sampled(sensor.rows());
  for (std::size_t row = 0; row < sampled.size(); ++row) {
    const unsigned missing = sensor.faults[row] & (acceleration_missing | angular_velocity_missing);
    const bool has_field = sensor.has_magnetometer() && !(sensor.faults[row] & field_missing);
    sampled[row] = missing != (acceleration_missing | angular_velocity_missing) || has_field;
  }
  return sampled;
}

/// Of the rows between its first and its last sample.
bool is_interleaved(const std::vector<bool>& sampled) {
  const auto first = std::ranges::find(sampled, true);
  if (first == sampled.end()) return false;
  auto end = sampled.end();
  while (!*(end - 1)) --end;
  const auto count = static_cast<double>(std::count(first, end, true));
  return count < max_interleaved_share * static_cast<double>(end - first);
}

template <class T>
std::vector<T> kept(const std::vector<T>& all, const std::vector<bool>& rows) {
  std::vector<T> some;
  for (std::size_t row = 0; row < all.size(); ++row)
    if (rows[row]) some.push_back(all[row]);
  return some;
}

void keep_rows(InsSensor& sensor, const std::vector<bool>& rows) {
  for (TriadColumns* columns : {&sensor.acceleration, &sensor.angular_velocity, &sensor.field})
    for (auto& axis : columns->axis) axis = kept(axis, rows);
  sensor.faults = kept(sensor.faults, rows);
}

/// Numbers the clocks of loggers that have none.
void number_clocks(std::vector<InsLogger>& loggers) {
  int next = 0;
  for (const InsLogger& logger : loggers) next = std::max(next, logger.shared_clock + 1);
  for (InsLogger& logger : loggers)
    if (logger.shared_clock < 0) logger.shared_clock = next++;
}

}  // namespace

std::optional<InsRecording> separate_interleaved_sensors(const InsRecording& recording) {
  std::vector<std::vector<bool>> sampled;  // empty: not interleaved
  for (const InsSensor& sensor : recording.sensors) {
    sampled.push_back(sampled_rows(sensor));
    if (!is_interleaved(sampled.back())) sampled.back().clear();
  }
  if (std::ranges::all_of(sampled, &std::vector<bool>::empty)) return std::nullopt;
  InsRecording separate{.loggers = recording.loggers, .sensors = recording.sensors, .remarks = recording.remarks};
  number_clocks(separate.loggers);
  std::vector<std::size_t> like;  // one sensor of each new logger
  std::vector<InsLogger> loggers;
  for (std::size_t s = 0; s < sampled.size(); ++s) {
    const std::size_t from = recording.sensors[s].logger;
    std::size_t at = 0;
    while (at < like.size() && (recording.sensors[like[at]].logger != from || sampled[like[at]] != sampled[s])) ++at;
    if (at == like.size()) {
      like.push_back(s);
      loggers.push_back(separate.loggers[from]);
      if (!sampled[s].empty()) loggers.back().time = kept(loggers.back().time, sampled[s]);
    }
    if (!sampled[s].empty()) keep_rows(separate.sensors[s], sampled[s]);
    separate.sensors[s].logger = at;
  }
  separate.loggers = std::move(loggers);
  return separate;
}

}  // namespace kinfer
