// SPDX-License-Identifier: Apache-2.0
#include "kinfer/measurement/ins/ins_selection.hpp"

#include <fmt/ranges.h>

#include <algorithm>

#include "kinfer/base/expect.hpp"

namespace kinfer {
namespace {

template <class T>
std::vector<T> part(const std::vector<T>& all, std::ptrdiff_t first, std::ptrdiff_t end) {
  return all.empty() ? all : std::vector<T>(all.begin() + first, all.begin() + end);
}

}  // namespace

InsRecording select_sensors(const InsRecording& recording, const std::vector<std::size_t>& sensors) {
  InsRecording result{.loggers = {}, .sensors = {}, .remarks = recording.remarks};
  std::vector<std::size_t> used;
  for (const std::size_t s : sensors) {
    KINFER_EXPECT(s < recording.sensors.size());
    const std::size_t logger = recording.sensors[s].logger;
    const auto at = static_cast<std::size_t>(std::ranges::find(used, logger) - used.begin());
    if (at == used.size()) {
      used.push_back(logger);
      result.loggers.push_back(recording.loggers[logger]);
    }
    result.sensors.push_back(recording.sensors[s]);
    result.sensors.back().logger = at;
  }
  return result;
}

Result<std::vector<std::size_t>> find_sensors(const InsRecording& recording, const std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const InsSensor& sensor : recording.sensors) known.push_back(sensor.name);
  std::vector<std::size_t> chosen;
  for (const std::string& name : names) {
    const auto place = std::ranges::find(known, name);
    if (place == known.end()) return error("no sensor {}; the log has {}", name, fmt::join(known, ", "));
    chosen.push_back(static_cast<std::size_t>(place - known.begin()));
  }
  return chosen;
}

InsRecording within(const InsRecording& recording, double begin, double end) {
  InsRecording result{.loggers = {}, .sensors = recording.sensors, .remarks = recording.remarks};
  const auto rows = [&](const std::vector<double>& time) {
    return std::pair{std::ranges::lower_bound(time, begin) - time.begin(),
                     std::ranges::upper_bound(time, end) - time.begin()};
  };
  for (const InsLogger& logger : recording.loggers) {
    const auto [first, last] = rows(logger.time);
    result.loggers.push_back({.name = logger.name,
                              .time = part(logger.time, first, std::max(first, last)),
                              .shared_clock = logger.shared_clock,
                              .states_unit = logger.states_unit});
  }
  for (InsSensor& sensor : result.sensors) {
    const auto [first, last] = rows(recording.loggers[sensor.logger].time);
    for (TriadColumns* columns : {&sensor.acceleration, &sensor.angular_velocity, &sensor.field})
      for (auto& axis : columns->axis) axis = part(axis, first, std::max(first, last));
    sensor.faults = part(sensor.faults, first, std::max(first, last));
  }
  return result;
}

}  // namespace kinfer
