// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/recording/recording_formats.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <string>

#include "kinfer/io/recording/ins_columns.hpp"
#include "kinfer/io/recording/ins_csv.hpp"
#include "kinfer/io/recording/ins_topics.hpp"
#include "kinfer/io/robot_log/message_log_formats.hpp"

namespace kinfer {
namespace {

std::string read_head(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string head(std::size_t{1} << 16, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));
  return head;
}

const RecordingFormat* recognised_format(const std::filesystem::path& path) {
  const std::string head = read_head(path);
  const std::span<const RecordingFormat> formats = recording_formats();
  const auto row = std::ranges::find_if(formats, [&](const RecordingFormat& f) { return f.recognise(head); });
  return row == formats.end() ? nullptr : &*row;
}

}  // namespace

std::span<const RecordingFormat> recording_formats() {
  static const std::array formats{
      RecordingFormat{.name = "CSV", .recognise = is_ins_csv, .append = append_ins_csv},
      RecordingFormat{.name = "robot log", .recognise = is_message_log, .append = append_all_ins_topics}};
  return formats;
}

bool is_recording(const std::filesystem::path& path) {
  return recognised_format(path) != nullptr;
}

Result<InsRecording> read_recording(std::span<const std::filesystem::path> paths) {
  InsRecording recording;
  for (const std::filesystem::path& path : paths) {
    const RecordingFormat* format = recognised_format(path);
    const auto done = (format ? format : &recording_formats().front())->append(path, recording);
    if (!done) return forward_error(done.error());
  }
  return recording;
}

}  // namespace kinfer
