// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <map>

#include "kinfer/io/recording/foreign/foreign_log.hpp"
#include "kinfer/io/recording/foreign/ins_remarks.hpp"

namespace kinfer {
namespace {

constexpr std::array triads_of{&InsSensor::acceleration, &InsSensor::angular_velocity, &InsSensor::field};
constexpr std::array triad_names{"specific force", "angular rate", "magnetic field"};

/// The log's rows among those of the union; both times rise.
std::vector<std::size_t> rows_in(const std::vector<double>& time, const std::vector<double>& all) {
  std::vector<std::size_t> rows;
  for (std::size_t k = 0, row = 0; row < time.size(); ++k)
    if (!(all[k] < time[row])) rows.push_back(k), ++row;
  return rows;
}

/// Whether two logs hold parts of one sensor.
bool share_a_sensor(const ForeignLog& a, const ForeignLog& b) {
  return std::ranges::any_of(a.sensors, [&](const InsSensor& s) {
    return std::ranges::find(b.sensors, s.name, &InsSensor::name) != b.sensors.end();
  });
}

Result<void> add_instruments(const InsSensor& part, const std::array<bool, 3>& stated,
                             const std::vector<std::size_t>& rows, std::size_t all_rows, const std::string& file,
                             ForeignLog& into) {
  auto at = std::ranges::find(into.sensors, part.name, &InsSensor::name);
  if (at == into.sensors.end()) {
    into.sensors.push_back({.name = part.name, .acceleration = {}, .angular_velocity = {}, .field = {}, .faults = {}});
    into.stated_units.push_back({});
    at = into.sensors.end() - 1;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const TriadColumns& from = part.*triads_of[i];
    if (!from.present()) continue;
    TriadColumns& to = (*at).*triads_of[i];
    if (to.present())
      return error("{}: sensor {}: its {} is in another file already; sensor names must be unique", file, part.name,
                   triad_names[i]);
    into.stated_units[static_cast<std::size_t>(at - into.sensors.begin())][i] = stated[i];
    for (std::size_t k = 0; k < 3; ++k) {
      to.axis[k].assign(all_rows, std::numeric_limits<float>::quiet_NaN());
      for (std::size_t row = 0; row < rows.size(); ++row) to.axis[k][rows[row]] = from.axis[k][row];
    }
  }
  return {};
}

/// Logs that hold instruments of the same sensors, on the union of their rows.
Result<ForeignLog> joined(const std::vector<ForeignLog>& logs) {
  ForeignLog whole;
  for (const ForeignLog& log : logs) {
    whole.has_free_acceleration |= log.has_free_acceleration;
    whole.states_time_unit |= log.states_time_unit;
    whole.name += (whole.name.empty() ? "" : "+") + log.name;
    whole.time.insert(whole.time.end(), log.time.begin(), log.time.end());
    whole.remarks.insert(whole.remarks.end(), log.remarks.begin(), log.remarks.end());
  }
  std::ranges::sort(whole.time);
  whole.time.erase(std::unique(whole.time.begin(), whole.time.end()), whole.time.end());
  for (const ForeignLog& log : logs) {
    const auto rows = rows_in(log.time, whole.time);
    for (std::size_t s = 0; s < log.sensors.size(); ++s)
      if (auto done = add_instruments(log.sensors[s], log.stated_units[s], rows, whole.time.size(), log.name, whole);
          !done)
        return forward_error(done.error());
  }
  return whole;
}

Result<void> append_log(ForeignLog log, InsRecording& recording) {
  const std::size_t first = recording.sensors.size();
  recording.loggers.push_back({.name = log.name, .time = std::move(log.time), .states_unit = log.states_time_unit});
  recording.remarks.insert(recording.remarks.end(), log.remarks.begin(), log.remarks.end());
  for (InsSensor& sensor : log.sensors) {
    if (!sensor.acceleration.present() && log.has_free_acceleration)
      return error(
          "{}: sensor {} has linear or free acceleration only, from which gravity is removed, which cannot be "
          "mended; export what the accelerometer measures",
          log.name, sensor.name);
    if (!sensor.acceleration.present() || !sensor.angular_velocity.present())
      return error("{}: sensor {} has no {}; where it stands in another file, give both", log.name, sensor.name,
                   sensor.acceleration.present() ? "angular rate (gyroscope)" : "specific force (accelerometer)");
    if (std::ranges::find(recording.sensors, sensor.name, &InsSensor::name) != recording.sensors.end())
      return error("{}: sensor {} also appears in another file; sensor names must be unique", log.name, sensor.name);
    sensor.logger = recording.loggers.size() - 1;
    recording.sensors.push_back(std::move(sensor));
  }
  add_time_remarks(recording, recording.loggers.size() - 1, log.name);
  return screen_sensors(recording, first, log.name, log.stated_units);
}

}  // namespace

Result<void> append_foreign_logs(std::vector<ForeignLog> logs, InsRecording& recording) {
  while (!logs.empty()) {
    std::vector<ForeignLog> group;
    group.push_back(std::move(logs.front()));
    logs.erase(logs.begin());
    for (std::size_t k = 0; k < logs.size();)
      if (std::ranges::any_of(group, [&](const ForeignLog& g) { return share_a_sensor(g, logs[k]); })) {
        group.push_back(std::move(logs[k]));
        logs.erase(logs.begin() + static_cast<std::ptrdiff_t>(k));
        k = 0;
      } else {
        ++k;
      }
    KINFER_TRY(log, joined(group));
    if (auto done = append_log(std::move(log), recording); !done) return done;
  }
  return {};
}

}  // namespace kinfer
