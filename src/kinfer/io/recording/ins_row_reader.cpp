// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/recording/ins_row_reader.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinfer/base/constants.hpp"
#include "kinfer/io/recording/possible_times.hpp"
#include "kinfer/io/text/plain_decimal.hpp"
#include "kinfer/io/text/trim.hpp"

namespace kinfer {
namespace {

constexpr double absent = std::numeric_limits<double>::quiet_NaN();
constexpr double largest_reading = 1e9;  // [m/s²], [rad/s], [µT]; the sums of squares stay finite
constexpr std::size_t period_rows = 20;  // after which the time between them is judged
constexpr int gravity_rows = 100;        // over which the mean specific force is compared with gravity

/// The cell as a number, NaN where it is empty or not finite; nothing where it is no number.
std::optional<double> cell_value(std::string_view cell) {
  double value = absent;
  const char* end = cell.data() + cell.size();
  if (!cell.empty() && read_plain_decimal(cell.data(), end, value) == end) return value;
  cell = without_quotes(trim(cell));
  if (cell.empty()) return absent;
  const auto parsed = parse_number(cell);
  if (!parsed) return std::nullopt;
  return std::isfinite(*parsed) ? *parsed : absent;
}

}  // namespace

InsRowReader::InsRowReader(std::vector<std::string> sensors, std::string name_in_messages, RowTimes times)
    : sensors_(std::move(sensors)), name_(std::move(name_in_messages)), times_(times) {
  row_.sensors.resize(sensors_.size());
  values_.resize(sensors_.size());
  gravity_.resize(sensors_.size());
}

Result<void> InsRowReader::add(std::string_view bytes, const Sink& sink) {
  while (!bytes.empty()) {
    const std::size_t end = bytes.find('\n');
    if (end == std::string_view::npos) {
      partial_ += bytes;
      return {};
    }
    Result<void> done;
    if (partial_.empty()) {
      done = add_line(bytes.substr(0, end), sink, false);
    } else {
      partial_ += bytes.substr(0, end);
      const std::string line = std::exchange(partial_, {});
      done = add_line(line, sink, false);
    }
    if (!done) return done;
    bytes.remove_prefix(end + 1);
  }
  return {};
}

Result<void> InsRowReader::finish(const Sink& sink) {
  if (!partial_.empty()) {
    const std::string line = std::exchange(partial_, {});
    if (auto done = add_line(line, sink, true); !done) return done;
  }
  if (!columns_) return error("{}: the file is empty", name_);
  if (rows_ == 0) return error("{}: the file has a header but no rows", name_);
  return first_times_.size() < period_rows ? check_first_times() : Result<void>{};
}

Result<void> InsRowReader::add_line(std::string_view line, const Sink& sink, bool is_last) {
  ++line_;
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  const std::string_view content = trim(line);
  if (content.empty() || content.front() == '#') return {};
  return columns_ ? read_row(line, sink, is_last) : read_header(std::string(line) + "\n");
}

Result<void> InsRowReader::read_header(const std::string& line) {
  KINFER_TRY(header, read_csv_header(line, name_));
  if (auto distinct = expect_distinct_columns(header, name_); !distinct) return distinct;
  InsRecording log;
  KINFER_TRY(columns, parse_ins_columns(header, name_, log));
  std::vector<std::string> names, unused;
  for (const InsSensor& sensor : log.sensors) {
    names.push_back(sensor.name);
    if (std::ranges::find(sensors_, sensor.name) == sensors_.end()) unused.push_back(sensor.name);
  }
  for (const std::string& sensor : sensors_)
    if (std::ranges::find(names, sensor) == names.end())
      return error("{}: the chain has a sensor {}, the log has none of that name; it has {}", name_, sensor,
                   fmt::join(names, ", "));
  if (!unused.empty())
    remarks_.push_back(fmt::format("{}: not part of the chain and not used: {}", name_, fmt::join(unused, ", ")));
  for (const InsColumn& column : columns.columns) {
    Target& target = targets_.emplace_back();
    if (!column.sensor) continue;
    const auto place = std::ranges::find(sensors_, log.sensors[*column.sensor].name);
    if (place == sensors_.end()) continue;
    target = {static_cast<int>(place - sensors_.begin()), column.instrument, column.axis, column.factor};
  }
  header_ = header;
  columns_ = columns;
  return {};
}

Result<void> InsRowReader::read_row(std::string_view line, const Sink& sink, bool is_last) {
  const auto cells = static_cast<std::size_t>(std::ranges::count(line, ',')) + 1;
  if (cells != targets_.size()) {
    if (!is_last) return error("{}", describe_column_count(name_, line_, targets_.size(), cells, ','));
    remarks_.push_back(fmt::format("{}: the last line is cut off and is not used", name_));
    return {};
  }
  double time = absent;
  for (auto& sensor : values_) sensor.fill(Vec3::Constant(absent));
  std::size_t begin = 0;
  for (std::size_t c = 0; c < cells; ++c) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    const std::string_view cell = line.substr(begin, end - begin);
    begin = end + 1;
    const Target& target = targets_[c];
    if (target.sensor < 0 && c != columns_->time_column) continue;
    const auto value = cell_value(cell);
    if (!value) return error("{}:{}: {}", name_, line_, describe_invalid_number(header_.columns[c], cell, '.'));
    if (c == columns_->time_column)
      time = columns_->columns[c].factor * *value;
    else if (const double si = target.factor * *value;
             std::abs(si) <= largest_reading)  // or a fault of the line: missing
      values_[static_cast<std::size_t>(target.sensor)][target.instrument][static_cast<Eigen::Index>(target.axis)] = si;
  }
  if (auto checked = check_time(time); !checked) return checked;
  row_.time = time;
  if (first_times_.size() < period_rows) {
    first_times_.push_back(time);
    if (first_times_.size() == period_rows)
      if (auto checked = check_first_times(); !checked) return checked;
  }
  for (std::size_t s = 0; s < values_.size(); ++s) {
    const auto& [force, rate, field] = values_[s];
    row_.sensors[s] = {.time = time,
                       .acceleration = force,
                       .angular_velocity = rate,
                       .field = field,
                       .has_acceleration = force.allFinite(),
                       .has_angular_velocity = rate.allFinite(),
                       .has_field = field.allFinite()};
  }
  ++rows_;
  if (auto checked = check_gravity(); !checked) return checked;
  return sink(row_);
}

Result<void> InsRowReader::check_time(double time) {
  if (!std::isfinite(time)) return error("{}:{}: column t: expected a time, found none", name_, line_);
  if (times_ == RowTimes::any) return {};
  if (rows_ > 0 && time < row_.time)
    return error("{}:{}: the time goes backwards, from {} s to {} s; is this several recordings in one file?", name_,
                 line_, row_.time, time);
  if (rows_ > 0 && time == row_.time)
    return error("{}:{}: duplicate time {} s; the time must be strictly increasing", name_, line_, time);
  return {};
}

/// In ms instead of s: told by the first rows, if they are in order.
Result<void> InsRowReader::check_first_times() const {
  return times_ == RowTimes::any ? Result<void>{} : expect_seconds(first_times_, name_);
}

/// In g instead of m/s², or a unit in between: told by the mean of the first rows.
Result<void> InsRowReader::check_gravity() {
  constexpr double least = 0.3, most = 3.0;  // of standard gravity; no machine keeps falling
  if (rows_ > gravity_rows) return {};
  for (std::size_t s = 0; s < gravity_.size(); ++s) {
    Gravity& gravity = gravity_[s];
    if (row_.sensors[s].has_acceleration) gravity.sum += row_.sensors[s].acceleration.norm(), ++gravity.rows;
    const double mean = gravity.sum / std::max(1, gravity.rows);
    if (rows_ == gravity_rows && gravity.rows > 0 &&
        (mean < least * standard_gravity || mean > most * standard_gravity))
      return error(
          "{}: {}: gravity reads {:.2f} m/s² instead of 9.81: is the file in another unit? In g the header is "
          "{}_ax[g]",
          name_, sensors_[s], mean, sensors_[s]);
  }
  return {};
}

}  // namespace kinfer
