// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/recording/orientation_csv.hpp"

#include <fmt/format.h>

#include <iterator>
#include <ostream>

#include "kinfer/io/files/text_file.hpp"
#include "kinfer/io/text/csv_text.hpp"

namespace kinfer {
namespace {

std::string header(const InsRecording& recording, const std::vector<SensorOrientations>& orientations) {
  std::string text = "t";
  for (const SensorOrientations& o : orientations)
    for (const char* part : {"qw", "qx", "qy", "qz"})
      text += "," + csv_cell(fmt::format("{}_{}", recording.sensors[o.sensor].name, part));
  return text + "\n";
}

void add_row(fmt::memory_buffer& text, const InsRecording& recording, std::size_t logger, std::size_t row,
             const std::vector<SensorOrientations>& orientations) {
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "{}", recording.loggers[logger].time[row]);
  for (const SensorOrientations& o : orientations) {
    if (recording.sensors[o.sensor].logger != logger) {
      fmt::format_to(out, ",,,,");
      continue;
    }
    const Quat& q = o.world_q_sensor[row];
    fmt::format_to(out, ",{:.7f},{:.7f},{:.7f},{:.7f}", q.w(), q.x(), q.y(), q.z());
  }
  text.push_back('\n');
}

void write_rows(std::ostream& file, const InsRecording& recording,
                const std::vector<SensorOrientations>& orientations) {
  constexpr std::size_t flush_size = std::size_t{1} << 20;
  fmt::memory_buffer text;
  const auto flush = [&] {
    file.write(text.data(), static_cast<std::streamsize>(text.size()));
    text.clear();
  };
  for (std::size_t logger = 0; logger < recording.loggers.size(); ++logger)
    for (std::size_t row = 0; row < recording.loggers[logger].time.size(); ++row) {
      add_row(text, recording, logger, row, orientations);
      if (text.size() > flush_size) flush();
    }
  flush();
}

}  // namespace

Result<void> write_orientation_csv(const std::filesystem::path& path, const InsRecording& recording,
                                   const std::vector<SensorOrientations>& orientations) {
  return write_file(path, [&](std::ostream& file) {
    file << header(recording, orientations);
    write_rows(file, recording, orientations);
  });
}

}  // namespace kinfer
