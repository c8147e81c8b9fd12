// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/recording/foreign/log_columns.hpp"

#include <algorithm>

#include "kinfer/io/recording/foreign/header_guess.hpp"
#include "kinfer/io/text/units.hpp"

namespace kinfer {
namespace {

constexpr std::array log_dimensions{Dimension::acceleration, Dimension::angular_rate, Dimension::magnetic_field};

/// "Acc_X [g]" -> "Acc_X"; brackets that hold no unit belong to the maker's numbering: "X Accel [x8004]".
ColumnHeader plain_header(std::string_view text) {
  ColumnHeader header = parse_column_header(text);
  if (header.has_unit && !find_unit(header.unit)) header.has_unit = false, header.unit = {};
  return header;
}

std::optional<std::size_t> index_of(const CsvHeader& header, std::string_view theirs) {
  for (std::size_t c = 0; c < header.columns.size(); ++c)
    if (header.columns[c] == theirs || plain_header(header.columns[c]).name == theirs ||
        fmt::format("#{}", c + 1) == theirs)
      return c;
  return std::nullopt;
}

std::size_t instrument_of(ChannelKind kind) {
  return kind == ChannelKind::force ? 0 : kind == ChannelKind::rate ? 1 : 2;
}

/// The unit that the map states for the column, the header, or the map for the instrument; SI otherwise.
Result<void> set_factor(LogColumn& column, const ColumnHeader& stated, const ColumnHeader& in_file, const InsMap& map,
                        const std::string& where) {
  const std::string_view unit = stated.has_unit    ? stated.unit
                                : in_file.has_unit ? in_file.unit
                                                   : std::string_view(map.units[column.instrument]);
  if (unit.empty()) return {};
  const auto found = find_unit(unit);
  const bool is_arbitrary = found && found->dimension == Dimension::one && column.instrument == 2;
  if (!found || (found->dimension != log_dimensions[column.instrument] && !is_arbitrary))
    return error("{}: column {}: expected {}, found \"{}\"", where, in_file.name,
                 describe(log_dimensions[column.instrument]), unit);
  column.factor = found->factor;
  column.has_unit = true;
  return {};
}

/// [s] per unit that the header states, if it does.
std::optional<double> stated_time_unit(const ColumnHeader& header) {
  const auto unit = header.has_unit ? find_unit(header.unit) : std::nullopt;
  if (!unit || unit->dimension != Dimension::time) return std::nullopt;
  return unit->factor;
}

ClockColumn clock_column(std::size_t index, const ColumnHeader& header) {
  const auto unit = stated_time_unit(header);
  return {index, unit.value_or(1.0), unit.has_value()};
}

Result<LogColumns> mapped_columns(const CsvHeader& header, const InsMap& map, const std::string& where) {
  LogColumns found;
  for (const auto& [ours, text] : map.columns) {
    const ColumnHeader theirs = plain_header(text);
    const auto index = index_of(header, theirs.name);
    if (!index) return error("{}: no column is named \"{}\", which the column map wants", where, theirs.name);
    const ColumnHeader in_file = plain_header(header.columns[*index]);
    if (ours == "t") {
      found.clock = clock_column(*index, theirs.has_unit ? theirs : in_file);
      continue;
    }
    const GuessedColumn channel = guess_column(ours);
    if (channel.kind == ChannelKind::other || channel.kind == ChannelKind::time ||
        channel.kind == ChannelKind::free_acceleration)
      return error("{}: the column map has \"{}\", expected t, or SENSOR_ax ... SENSOR_mz", where, ours);
    LogColumn column{*index, channel.sensor, instrument_of(channel.kind), channel.axis, 1.0, false};
    if (auto done = set_factor(column, theirs, in_file, map, where); !done) return forward_error(done.error());
    found.channels.push_back(column);
  }
  return found;
}

Result<LogColumns> guessed_columns(const CsvHeader& header, const InsMap& map, const std::string& where) {
  constexpr std::array counter_names{"PacketCounter", "Packet Counter", "Counter", "counter",
                                     "Sample",        "Index",          "Frame"};
  LogColumns found;
  for (std::size_t c = 0; c < header.columns.size(); ++c) {
    const ColumnHeader in_file = plain_header(header.columns[c]);
    const GuessedColumn guess = guess_column(in_file.name);
    if (guess.kind == ChannelKind::time && !found.clock.index) found.clock = clock_column(c, in_file);
    if (std::ranges::find(counter_names, in_file.name) != counter_names.end() && !found.counter.index)
      found.counter.index = c;
    found.has_free_acceleration |= guess.kind == ChannelKind::free_acceleration;
    if (guess.kind != ChannelKind::force && guess.kind != ChannelKind::rate && guess.kind != ChannelKind::field)
      continue;
    LogColumn column{c, guess.sensor, instrument_of(guess.kind), guess.axis, 1.0, false};
    const bool is_taken = std::ranges::any_of(found.channels, [&](const LogColumn& other) {
      return other.sensor == column.sensor && other.instrument == column.instrument && other.axis == column.axis;
    });
    if (is_taken) continue;  // a second, derived column of the same channel
    if (auto done = set_factor(column, {}, in_file, map, where); !done) return forward_error(done.error());
    found.channels.push_back(column);
  }
  return found;
}

/// The first number after the word in the lines before the header; 0 where there is none.
double number_after(std::string_view preamble, const std::string& word) {
  const auto at = word.empty() ? std::string_view::npos : preamble.find(word);
  if (at == std::string_view::npos) return 0.0;
  const std::string_view rest = preamble.substr(at + word.size());
  const auto begin = rest.find_first_of("0123456789\n");
  if (begin == std::string_view::npos || rest[begin] == '\n') return 0.0;
  const auto end = std::min(rest.find_first_not_of("0123456789.", begin), rest.size());
  return parse_number(rest.substr(begin, end - begin)).value_or(0.0);
}

/// Overrides what was guessed by what the map says of a clock.
Result<void> apply_clock(const InsClock& clock, const CsvHeader& header, std::string_view preamble,
                         const std::string& where, ClockColumn& column) {
  if (!clock.column.empty()) {
    const ColumnHeader theirs = plain_header(clock.column);
    column.index = index_of(header, theirs.name);
    if (column.index)
      column = clock_column(*column.index, theirs.has_unit ? theirs : plain_header(header.columns[*column.index]));
  }
  const double rate = number_after(preamble, clock.rate_from);
  if (clock.tick > 0.0) column.tick = clock.tick;
  if (rate > 0.0) column.tick = 1.0 / rate;
  column.states_unit |= clock.tick > 0.0 || rate > 0.0;
  if (!(column.tick > 0.0)) return error("{}: the clock's tick is {} s", where, column.tick);
  return {};
}

}  // namespace

Result<LogColumns> find_log_columns(const CsvHeader& header, std::string_view preamble, const InsMap& map,
                                    const std::string& name) {
  const std::string where = fmt::format("{}:{}", name, header.line);
  KINFER_TRY(found, map.columns.empty() ? guessed_columns(header, map, where) : mapped_columns(header, map, where));
  LogColumns columns = std::move(found);
  if (auto done = apply_clock(map.clock, header, preamble, where, columns.clock); !done)
    return forward_error(done.error());
  if (auto done = apply_clock(map.counter, header, preamble, where, columns.counter); !done)
    return forward_error(done.error());
  if (columns.channels.empty() && columns.has_free_acceleration)
    return error(
        "{}: the file holds linear or free acceleration, from which gravity is removed, which cannot be mended; "
        "export what the accelerometer measures",
        where);
  if (columns.channels.empty())
    return error(
        "{}: no column is known as that of an accelerometer, gyroscope or magnetometer; a column map "
        "(--columns) can say which is which",
        where);
  columns.counts_rows =
      !columns.clock.index && !columns.counter.index && map.counter.column.empty() && map.counter.tick > 0.0;
  if (!columns.clock.index && !columns.counter.index && !columns.counts_rows)
    return error("{}: no column is known as a time; a column map (--columns) can say t = \"name [unit]\"", where);
  return columns;
}

}  // namespace kinfer
