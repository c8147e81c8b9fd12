// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/recording/foreign/foreign_log.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinfer/io/recording/foreign/log_columns.hpp"

namespace kinfer {
namespace {

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

TriadColumns& instrument_columns(InsSensor& sensor, std::size_t instrument) {
  return instrument == 0 ? sensor.acceleration : instrument == 1 ? sensor.angular_velocity : sensor.field;
}

/// "12:34:56.789", with a date before it or not: seconds of the day.
std::optional<double> parse_time_of_day(std::string_view cell) {
  if (const auto at = cell.find_last_of(" T"); at != std::string_view::npos) cell.remove_prefix(at + 1);
  if (cell.ends_with('Z')) cell.remove_suffix(1);
  const auto first = cell.find(':'), second = first == std::string_view::npos ? first : cell.find(':', first + 1);
  if (second == std::string_view::npos) return std::nullopt;
  const auto hours = parse_number(cell.substr(0, first)),
             minutes = parse_number(cell.substr(first + 1, second - first - 1)),
             seconds = parse_number(cell.substr(second + 1));
  if (!hours || !minutes || !seconds) return std::nullopt;
  return 3600.0 * *hours + 60.0 * *minutes + *seconds;
}

/// A column of the table as a clock.
class ClockReader {
 public:
  ClockReader(const CsvTable& table, std::size_t column, double tick, double wraps, const std::string& name)
      : table_(table), column_(column), tick_(tick), wraps_(wraps), name_(name) {}

  bool has_values() const {
    for (std::size_t row = 0; row < std::min<std::size_t>(table_.rows(), 20); ++row)
      if (!table_.cell(row, column_).empty()) return true;
    return false;
  }

  /// [s] of the next row; NaN where the cell is empty.
  Result<double> next(std::size_t row) {
    constexpr double day = 86400.0;  // [s]
    const std::string_view cell = table_.cell(row, column_);
    if (cell.empty()) return no_value;
    auto value = parse_number(cell, table_.header.decimal);
    double wraps = wraps_, tick = tick_;
    if (!value && (value = parse_time_of_day(cell))) wraps = day, tick = 1.0;
    if (!value || !std::isfinite(*value))
      return error("{}:{}: {}", name_, table_.line[row],
                   describe_invalid_number(table_.header.columns[column_], cell, table_.header.decimal));
    if (wraps > 0.0 && *value < before_ - 0.5 * wraps) turns_ += 1.0;
    before_ = *value;
    return tick * (*value + turns_ * wraps);
  }

 private:
  const CsvTable& table_;
  std::size_t column_;
  double tick_, wraps_;
  const std::string& name_;
  double before_ = -std::numeric_limits<double>::infinity(), turns_ = 0.0;
};

/// The rows whose times rise; the times of the others repeat the one before.
struct TimedRows {
  std::vector<std::size_t> rows;
  std::vector<double> time;
  std::size_t repeated = 0;
  bool states_unit = false;
};

Result<TimedRows> read_times(const CsvTable& table, const LogColumns& columns, const InsMap& map,
                             const std::string& name) {
  if (columns.counts_rows) {
    TimedRows counted;
    counted.states_unit = columns.counter.states_unit;
    for (std::size_t row = 0; row < table.rows(); ++row) {
      counted.rows.push_back(row);
      counted.time.push_back(columns.counter.tick * static_cast<double>(row));
    }
    if (counted.time.empty()) return error("{}: the file has no rows", name);
    return counted;
  }
  const bool has_clock = columns.clock.index && (!columns.counter.index ||
                                                 ClockReader(table, *columns.clock.index, 1.0, 0.0, name).has_values());
  const ClockColumn& column = has_clock ? columns.clock : columns.counter;
  ClockReader clock(table, *column.index, column.tick, has_clock ? map.clock.wraps : map.counter.wraps, name);
  TimedRows timed;
  timed.states_unit = column.states_unit;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    KINFER_TRY(time, clock.next(row));
    if (std::isnan(time)) continue;
    if (!timed.time.empty() && !(time > timed.time.back())) {
      if (time < timed.time.back())
        return error(
            "{}:{}: the time goes backwards, from {} s to {} s; is this several recordings in one file, or a clock "
            "that starts again (wraps in a column map)?",
            name, table.line[row], timed.time.back(), time);
      ++timed.repeated;
      continue;
    }
    timed.rows.push_back(row);
    timed.time.push_back(time);
  }
  if (timed.time.empty()) return error("{}: the file has a header but no rows with a time", name);
  return timed;
}

Result<std::vector<float>> read_channel(const CsvTable& table, const LogColumn& column, const TimedRows& timed,
                                        const std::string& name) {
  std::vector<float> values;
  values.reserve(timed.rows.size());
  for (const std::size_t row : timed.rows) {
    const std::string_view cell = table.cell(row, column.index);
    const auto value = cell.empty() ? no_value : parse_number(cell, table.header.decimal);
    if (!value)
      return error("{}:{}: {}", name, table.line[row],
                   describe_invalid_number(table.header.columns[column.index], cell, table.header.decimal));
    values.push_back(std::isfinite(*value) ? static_cast<float>(column.factor * *value)
                                           : std::numeric_limits<float>::quiet_NaN());
  }
  return values;
}

/// The name of sensors that no column names: what the map says, the file's, or the folder's where the file holds one
/// instrument only, as those of phones do.
std::string sensor_name(const std::filesystem::path& path, const InsMap& map, const LogColumns& columns) {
  const auto has = [&](std::size_t instrument) {
    return std::ranges::any_of(columns.channels, [&](const LogColumn& c) { return c.instrument == instrument; });
  };
  std::error_code ignored;
  std::string folder = std::filesystem::absolute(path, ignored).parent_path().filename().string();
  if (folder.ends_with(".zip")) folder.erase(folder.size() - 4);
  const bool by_folder = map.sensor == "folder" || (map.sensor.empty() && !(has(0) && has(1)));
  std::string name = by_folder ? folder : map.sensor.empty() ? path.stem().string() : map.sensor;
  for (char& c : name)
    if (c == ' ' || c == ',' || c == ';') c = '_';
  return name.empty() ? "sensor" : name;
}

InsSensor& sensor_of(ForeignLog& log, const std::string& name) {
  const auto at = std::ranges::find(log.sensors, name, &InsSensor::name);
  if (at != log.sensors.end()) return *at;
  log.stated_units.push_back({});
  return log.sensors.emplace_back(
      InsSensor{.name = name, .acceleration = {}, .angular_velocity = {}, .field = {}, .faults = {}});
}

void orient(TriadColumns& triad, double sign, const Mat3& axes) {
  if (!triad.present()) return;
  for (std::size_t row = 0; row < triad.axis[0].size(); ++row) {
    const Vec3 v = sign * axes * triad.at(row);
    for (std::size_t k = 0; k < 3; ++k) triad.axis[k][row] = static_cast<float>(v[static_cast<Eigen::Index>(k)]);
  }
}

Result<void> expect_triads(const ForeignLog& log, const std::string& name, int line) {
  constexpr std::array instruments{"specific force", "angular rate", "magnetic field"};
  for (InsSensor sensor : log.sensors)
    for (std::size_t i = 0; i < 3; ++i) {
      const TriadColumns& triad = instrument_columns(sensor, i);
      const auto n = std::ranges::count_if(triad.axis, [](const auto& axis) { return !axis.empty(); });
      if (n != 0 && n != 3)
        return error("{}:{}: sensor {}: the {} has {} of three columns", name, line, sensor.name, instruments[i], n);
    }
  return {};
}

}  // namespace

Result<ForeignLog> parse_foreign_log(std::string_view text, const std::filesystem::path& path, const InsMap& map) {
  const std::string name = path.string();
  if (!map.refuse.empty()) return error("{}: {}", name, map.refuse);
  KINFER_TRY(table, split_csv(text, name, map.format));
  KINFER_TRY(columns, find_log_columns(table.header, text.substr(0, table.header.body), map, name));
  KINFER_TRY(timed, read_times(table, columns, map, name));
  ForeignLog log;
  log.name = path.filename().string();
  const std::string unnamed = sensor_name(path, map, columns);
  for (const LogColumn& column : columns.channels) {
    KINFER_TRY(values, read_channel(table, column, timed, name));
    InsSensor& sensor = sensor_of(log, column.sensor.empty() ? unnamed : column.sensor);
    instrument_columns(sensor, column.instrument).axis[column.axis] = std::move(values);
    if (column.has_unit)
      log.stated_units[static_cast<std::size_t>(&sensor - log.sensors.data())][column.instrument] = true;
  }
  if (auto done = expect_triads(log, name, table.header.line); !done) return forward_error(done.error());
  for (InsSensor& sensor : log.sensors)
    for (std::size_t i = 0; i < 3; ++i) orient(instrument_columns(sensor, i), map.sign[i], map.axes);
  log.has_free_acceleration = columns.has_free_acceleration;
  log.time = std::move(timed.time);
  log.states_time_unit = timed.states_unit;
  if (timed.repeated > 0)
    log.remarks.push_back(
        fmt::format("{}: {} rows have the time of the row before and are not used", name, timed.repeated));
  if (!map.title.empty()) log.remarks.push_back(fmt::format("{}: read as {}", name, map.title));
  return log;
}

}  // namespace kinfer
