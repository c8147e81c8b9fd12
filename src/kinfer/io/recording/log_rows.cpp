// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/recording/log_rows.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "kinfer/io/recording/ins_columns.hpp"
#include "kinfer/io/recording/ins_row_reader.hpp"
#include "kinfer/io/recording/possible_times.hpp"
#include "kinfer/io/recording/recording_formats.hpp"

namespace kinfer {
namespace {

constexpr std::size_t piece_size = 1 << 16;

/// Index of the sensor of each name.
Result<std::vector<std::size_t>> indices_of(const std::vector<std::string>& sensors, const InsRecording& recording) {
  std::vector<std::size_t> indices;
  std::vector<std::string> known;
  for (const InsSensor& sensor : recording.sensors) known.push_back(sensor.name);
  for (const std::string& name : sensors) {
    const auto found = std::ranges::find(known, name);
    if (found == known.end())
      return error("the chain has a sensor {}, the log has none of that name; it has {}", name, fmt::join(known, ", "));
    indices.push_back(static_cast<std::size_t>(found - known.begin()));
  }
  return indices;
}

/// The next bytes; empty at the end.
std::string_view next_piece(std::ifstream& file, std::string& buffer) {
  file.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
  return {buffer.data(), static_cast<std::size_t>(std::max<std::streamsize>(0, file.gcount()))};
}

Result<std::vector<std::string>> each_csv_row(std::ifstream& file, std::string_view head, const std::string& name,
                                              const std::vector<std::string>& sensors, const InsRowSink& sink) {
  InsRowReader reader(sensors, name);
  if (auto done = reader.add(head, sink); !done) return forward_error(done.error());
  std::string buffer(piece_size, '\0');
  for (std::string_view piece = next_piece(file, buffer); !piece.empty(); piece = next_piece(file, buffer))
    if (auto done = reader.add(piece, sink); !done) return forward_error(done.error());
  if (file.bad()) return error("{}: reading stopped with an input error", name);
  if (auto done = reader.finish(sink); !done) return forward_error(done.error());
  return reader.remarks();
}

}  // namespace

Result<void> each_row_of(const InsRecording& recording, const std::vector<std::string>& sensors,
                         const InsRowSink& sink) {
  KINFER_TRY(indices, indices_of(sensors, recording));
  std::vector<std::size_t> next(recording.loggers.size(), 0);
  InsRow row;
  row.sensors.resize(indices.size());
  for (;;) {
    double time = std::numeric_limits<double>::infinity();
    for (std::size_t l = 0; l < next.size(); ++l)
      if (next[l] < recording.loggers[l].time.size()) time = std::min(time, recording.loggers[l].time[next[l]]);
    if (!std::isfinite(time)) return {};
    row.time = time;
    for (std::size_t s = 0; s < indices.size(); ++s) {
      const InsSensor& sensor = recording.sensors[indices[s]];
      const std::vector<double>& times = recording.loggers[sensor.logger].time;
      const std::size_t at = next[sensor.logger];
      row.sensors[s] = at < times.size() && times[at] <= time ? sample(sensor, times, at) : InsSample{.time = time};
    }
    for (std::size_t l = 0; l < next.size(); ++l)
      if (next[l] < recording.loggers[l].time.size() && recording.loggers[l].time[next[l]] <= time) ++next[l];
    if (auto done = sink(row); !done) return done;
  }
}

Result<std::vector<std::string>> each_log_row(const std::vector<std::string>& logs,
                                              const std::vector<std::string>& sensors, const InsRowSink& sink) {
  if (logs.size() == 1) {
    std::ifstream file(logs.front(), std::ios::binary);
    std::string head(piece_size, '\0');
    const std::string_view begin = next_piece(file, head);
    if (is_ins_csv(begin)) return each_csv_row(file, begin, logs.front(), sensors, sink);
  }
  const std::vector<std::filesystem::path> paths(logs.begin(), logs.end());
  KINFER_TRY(recording, read_recording(paths));
  if (auto seconds = expect_seconds(recording); !seconds) return forward_error(seconds.error());
  if (auto done = each_row_of(recording, sensors, sink); !done)
    return error("{}: {}", fmt::join(logs, ", "), done.error().what);
  return recording.remarks;
}

}  // namespace kinfer
