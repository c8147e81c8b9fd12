// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/recording/ins_csv.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

#include "kinfer/io/files/compressed_text.hpp"
#include "kinfer/io/files/file_bytes.hpp"
#include "kinfer/io/recording/foreign/ins_remarks.hpp"
#include "kinfer/io/recording/ins_columns.hpp"
#include "kinfer/io/text/csv.hpp"
#include "kinfer/io/text/plain_decimal.hpp"
#include "kinfer/io/text/trim.hpp"

namespace kinfer {
namespace {

constexpr double missing_value = std::numeric_limits<double>::quiet_NaN();

/// Called with the offset of the next line, so that the caller can release the bytes before it.
/// A text of `size` bytes, of which the first are there.
struct GrowingText {
  std::string_view filled{};
  std::size_t size = 0;
  std::function<Result<std::string_view>()> grow{};            ///< more of it, from the beginning
  std::function<void(std::size_t)> pass = [](std::size_t) {};  ///< bytes before this offset are not read again
};

GrowingText whole(std::string_view text) {
  return {.filled = text, .size = text.size(), .grow = [text] { return Result<std::string_view>(text); }};
}

/// Reads the body of one file into the columns of its sensors.
class RowReader {
 public:
  RowReader(GrowingText text, const std::string& name, const CsvHeader& header, const InsColumns& columns,
            InsRecording& out)
      : text_(std::move(text)), name_(name), header_(header), columns_(columns), time_(out.loggers.back().time) {
    for (const InsColumn& column : columns.columns) {
      std::vector<float>* target = nullptr;
      if (column.sensor) {
        InsSensor& sensor = out.sensors[*column.sensor];
        TriadColumns* triads[] = {&sensor.acceleration, &sensor.angular_velocity, &sensor.field};
        target = &triads[column.instrument]->axis[column.axis];
      }
      targets_.push_back({target, column.factor});
    }
    reserve();
  }

  Result<void> read() {
    std::size_t at = header_.body;
    int line_number = header_.line;
    while (at < text_.size) {
      KINFER_TRY(end, end_of_line(at));
      const bool whole = end < text_.size;
      ++line_number;
      if (auto done = read_line(text_.filled.substr(at, end - at), line_number, whole); !done) return done;
      at = end + 1;
      if ((line_number & 0xfff) == 0) text_.pass(at);
    }
    return {};
  }

  bool has_truncated_last_line() const { return has_truncated_last_line_; }

 private:
  struct Target {
    std::vector<float>* column;  // null: the time, or an unused column
    double factor;
  };

  /// Of the line that begins at `at`; the size of the text where it has none.
  Result<std::size_t> end_of_line(std::size_t at) {
    std::size_t searched = at;
    for (;;) {
      const std::string_view filled = text_.filled;
      if (const void* found = std::memchr(filled.data() + searched, '\n', filled.size() - searched))
        return static_cast<std::size_t>(static_cast<const char*>(found) - filled.data());
      if (filled.size() == text_.size) return text_.size;
      searched = filled.size();
      KINFER_TRY(more, text_.grow());
      text_.filled = more;
    }
  }

  void reserve() {
    const auto rest = text_.filled.substr(header_.body);
    const std::size_t size = text_.size - header_.body, line = std::max<std::size_t>(rest.find('\n') + 1, 2);
    const std::size_t rows = size / line + size / line / 16 + 16;
    time_.reserve(rows);
    for (const Target& target : targets_)
      if (target.column) target.column->reserve(rows);
  }

  Result<void> read_line(std::string_view line, int number, bool whole) {
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    const auto first = line.find_first_not_of(whitespace);
    if (first == std::string_view::npos || line[first] == '#') return {};
    const char* at = line.data();
    const char* end = line.data() + line.size();
    std::size_t column = 0;
    double time = missing_value;
    for (; column < targets_.size() && at <= end; ++column) {
      double value = missing_value;
      if (auto after = read_cell(at, end, value))
        at = after;
      else if (auto slow = read_cell_slow_path(at, end, number, column, value); slow)
        at = *slow;
      else
        return tl::unexpected(slow.error());
      if (targets_[column].column)
        targets_[column].column->push_back(static_cast<float>(targets_[column].factor * value));
      else if (column == columns_.time_column)
        time = targets_[column].factor * value;
    }
    const bool ragged = column != targets_.size() || at <= end;
    if (ragged && !whole) return drop_last_line();
    if (ragged) return wrong_width(line, number);
    return add_time(time, number);
  }

  /// Fast path: a plain decimal or an empty cell, up to the delimiter. Returns the start of the next cell (end + 1
  /// after the last one), or null where the slow path is needed.
  static const char* read_cell(const char* at, const char* end, double& value) {
    if (at == end || *at == ',') return at + 1;  // empty: missing
    const char* after = read_plain_decimal(at, end, value);
    if (!after || (after != end && *after != ',')) return nullptr;
    return after + 1;
  }

  Result<const char*> read_cell_slow_path(const char* at, const char* end, int number, std::size_t column,
                                          double& value) const {
    const char* cell_end = std::find(at, end, ',');
    const std::string_view cell = without_quotes(trim({at, static_cast<std::size_t>(cell_end - at)}));
    value = missing_value;
    if (!cell.empty()) {
      const auto parsed = parse_number(cell);
      if (!parsed)
        return error("{}:{}: {}", name_, number, describe_invalid_number(header_.columns[column], cell, '.'));
      if (std::isfinite(*parsed)) value = *parsed;
    }
    return cell_end + 1;
  }

  /// Drops a last line that was cut off, as when a logger loses power.
  Result<void> drop_last_line() {
    for (const Target& target : targets_)
      if (target.column) target.column->resize(time_.size());
    has_truncated_last_line_ = true;
    return {};
  }

  Result<void> wrong_width(std::string_view line, int number) const {
    const auto found = std::ranges::count(line, ',') + 1;
    return error("{}", describe_column_count(name_, number, targets_.size(), static_cast<std::size_t>(found), ','));
  }

  Result<void> add_time(double time, int number) {
    if (!std::isfinite(time)) return error("{}:{}: column t: expected a time, found none", name_, number);
    if (!time_.empty() && !(time > time_.back())) {
      if (time < time_.back())
        return error("{}:{}: the time goes backwards, from {} s to {} s; is this several recordings in one file?",
                     name_, number, time_.back(), time);
      return error("{}:{}: duplicate time {} s; the time must be strictly increasing", name_, number, time);
    }
    time_.push_back(time);
    return {};
  }

  GrowingText text_;
  const std::string& name_;
  const CsvHeader& header_;
  const InsColumns& columns_;
  std::vector<double>& time_;
  std::vector<Target> targets_;
  bool has_truncated_last_line_ = false;
};

Result<void> append_logger(GrowingText text, const std::string& name, InsRecording& out) {
  KINFER_TRY(header, read_csv_header(text.filled, name));
  if (auto distinct = expect_distinct_columns(header, name); !distinct) return distinct;
  const std::size_t first = out.sensors.size();
  KINFER_TRY(columns, parse_ins_columns(header, name, out));
  for (const std::string& column : columns.unused_columns)
    out.remarks.push_back(fmt::format("{}: column {} is no channel of an INS and is not used", name, column));
  RowReader body(std::move(text), name, header, columns, out);
  if (auto done = body.read(); !done) return done;
  if (out.loggers.back().time.empty()) return error("{}: the file has a header but no rows", name);
  if (body.has_truncated_last_line())
    out.remarks.push_back(fmt::format("{}: the last line is cut off and is not used", name));
  add_time_remarks(out, out.loggers.size() - 1, name);
  return screen_sensors(out, first, name, columns.has_unit);
}

}  // namespace

Result<InsRecording> parse_ins_csv(std::string_view text, const std::string& name) {
  InsRecording out;
  if (auto done = append_logger(whole(text), name, out); !done) return forward_error(done.error());
  return out;
}

Result<void> append_ins_csv(const std::filesystem::path& path, InsRecording& out, const Observer& observer) {
  KINFER_TRY(file, FileBytes::open(path));
  const std::string name = path.string();
  const auto report = [&](std::size_t at, std::size_t size) {
    notify(observer,
           {.stage = "reading", .fraction = static_cast<double>(at) / static_cast<double>(size), .detail = name});
  };
  if (is_gzip(file.filled())) return packed_by_gzip(name);
  if (is_zstd(file.filled())) {
    if (auto done = file.fill_to(file.text().size()); !done) return done;
    KINFER_TRY(text, unpack_zstd_text(file.text(), name));
    GrowingText unpacked = whole(text);
    unpacked.pass = [&](std::size_t at) { report(at, text.size()); };
    return append_logger(std::move(unpacked), name, out);
  }
  return append_logger({.filled = file.filled(),
                        .size = file.text().size(),
                        .grow = [&]() -> Result<std::string_view> {
                          if (auto done = file.fill_to(file.filled().size() + 1); !done)
                            return forward_error(done.error());
                          return file.filled();
                        },
                        .pass =
                            [&](std::size_t at) {
                              report(at, file.text().size());
                              file.release_before(at);
                            }},
                       name, out);
}

Result<InsRecording> read_ins_csv(std::span<const std::filesystem::path> paths) {
  InsRecording out;
  for (const auto& path : paths)
    if (const auto done = append_ins_csv(path, out); !done) return forward_error(done.error());
  return out;
}

Result<InsRecording> read_ins_csv(const std::filesystem::path& path) {
  return read_ins_csv(std::span(&path, 1));
}

}  // namespace kinfer
