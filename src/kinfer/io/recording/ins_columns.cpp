// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/recording/ins_columns.hpp"

#include <algorithm>
#include <array>
#include <filesystem>

#include "kinfer/io/text/units.hpp"

namespace kinfer {
namespace {

constexpr std::array<char, 3> instrument_letters{'a', 'g', 'm'};
constexpr std::array<char, 3> axis_letters{'x', 'y', 'z'};
constexpr std::array dimensions{Dimension::acceleration, Dimension::angular_rate, Dimension::magnetic_field};
constexpr std::array instrument_names{"specific force", "angular rate", "magnetic field"};

struct Channel {
  std::string_view sensor;
  std::size_t instrument = 0, axis = 0;
};

/// "boom_gx" -> boom, 1, 0; empty where the name does not end in a channel.
std::optional<Channel> parse_channel(std::string_view name) {
  if (name.size() < 4 || name[name.size() - 3] != '_') return std::nullopt;
  const auto instrument = std::ranges::find(instrument_letters, name[name.size() - 2]);
  const auto axis = std::ranges::find(axis_letters, name.back());
  if (instrument == instrument_letters.end() || axis == axis_letters.end()) return std::nullopt;
  return Channel{name.substr(0, name.size() - 3), static_cast<std::size_t>(instrument - instrument_letters.begin()),
                 static_cast<std::size_t>(axis - axis_letters.begin())};
}

/// Factor of the header's unit; 1 where none is stated. A magnetic field may be in arbitrary units, "[1]".
Result<double> parse_unit_factor(const ColumnHeader& header, Dimension dimension, const std::string& name, int line) {
  if (!header.has_unit) return 1.0;
  const auto unit = find_unit(header.unit);
  const bool arbitrary = unit && unit->dimension == Dimension::one && dimension == Dimension::magnetic_field;
  if (unit && (unit->dimension == dimension || arbitrary)) return unit->factor;
  return error("{}:{}: column {}: expected {}, found \"{}\"", name, line, header.name, describe(dimension),
               header.unit);
}

struct SeenChannels {
  std::array<std::array<bool, 3>, 3> has{};  // [instrument][axis]
  std::array<bool, 3> has_unit{};
};

Result<void> expect_whole_triads(const SeenChannels& seen_channels, const std::string& sensor, const std::string& name,
                                 int line) {
  for (std::size_t i = 0; i < 3; ++i) {
    const auto n = std::ranges::count(seen_channels.has[i], true);
    if (n == 3 || (n == 0 && i == 2)) continue;
    std::string missing;
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (!seen_channels.has[i][axis])
        missing +=
            fmt::format("{}{}_{}{}", missing.empty() ? "" : ", ", sensor, instrument_letters[i], axis_letters[axis]);
    return error("{}:{}: sensor {}: the {} has no column {}", name, line, sensor, instrument_names[i], missing);
  }
  return {};
}

Result<std::size_t> sensor_index(InsRecording& out, std::size_t first, std::string_view sensor,
                                 const std::string& name) {
  const auto same = [&](const InsSensor& s) { return s.name == sensor; };
  const auto found = std::ranges::find_if(out.sensors, same);
  const auto index = static_cast<std::size_t>(found - out.sensors.begin());
  if (found != out.sensors.end() && index < first)
    return error("{}: sensor {} also appears in {}; sensor names must be unique", name, sensor,
                 out.loggers[found->logger].name);
  if (found == out.sensors.end())
    out.sensors.push_back({.name = std::string(sensor),
                           .logger = out.loggers.size() - 1,
                           .acceleration = {},
                           .angular_velocity = {},
                           .field = {},
                           .faults = {}});
  return index;
}

}  // namespace

Result<InsColumns> parse_ins_columns(const CsvHeader& header, const std::string& name, InsRecording& out) {
  InsColumns found;
  std::optional<std::size_t> time_column;
  const std::size_t first = out.sensors.size();
  out.loggers.push_back({.name = std::filesystem::path(name).filename().string(), .time = {}});
  std::vector<SeenChannels> seen_channels;
  for (std::size_t c = 0; c < header.columns.size(); ++c) {
    const ColumnHeader column = parse_column_header(header.columns[c]);
    InsColumn& meaning = found.columns.emplace_back();
    if (column.name == "t") {
      time_column = c;
      KINFER_TRY(factor, parse_unit_factor(column, Dimension::time, name, header.line));
      meaning.factor = factor;
      out.loggers.back().states_unit = column.has_unit;
    } else if (const auto channel = parse_channel(column.name)) {
      KINFER_TRY(factor, parse_unit_factor(column, dimensions[channel->instrument], name, header.line));
      KINFER_TRY(sensor, sensor_index(out, first, channel->sensor, name));
      meaning = {sensor, channel->instrument, channel->axis, factor};
      seen_channels.resize(out.sensors.size() - first);
      seen_channels[sensor - first].has[channel->instrument][channel->axis] = true;
      if (column.has_unit) seen_channels[sensor - first].has_unit[channel->instrument] = true;
    } else {
      found.unused_columns.emplace_back(column.name);
    }
  }
  if (!time_column)
    return error("{}:{}: expected a column t (time in s) and columns SENSOR_ax ... SENSOR_gz, found no t", name,
                 header.line);
  if (seen_channels.empty())
    return error("{}:{}: expected columns SENSOR_ax, SENSOR_ay ... SENSOR_gz beside t, found none", name, header.line);
  for (std::size_t i = 0; i < seen_channels.size(); ++i) {
    if (auto whole = expect_whole_triads(seen_channels[i], out.sensors[first + i].name, name, header.line); !whole)
      return forward_error(whole.error());
    found.has_unit.push_back(seen_channels[i].has_unit);
  }
  found.time_column = *time_column;
  return found;
}

bool is_ins_csv(std::string_view text) {
  const auto header = read_csv_header(text, "");
  if (!header) return false;
  bool has_time = false, has_channel = false;
  for (const std::string& text_of_column : header->columns) {
    const std::string_view name = parse_column_header(text_of_column).name;
    has_time |= name == "t";
    const auto channel = parse_channel(name);
    has_channel |= channel && channel->instrument < 2;
  }
  return has_time && has_channel;
}

}  // namespace kinfer
