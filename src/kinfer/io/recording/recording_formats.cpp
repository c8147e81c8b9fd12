// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/recording/recording_formats.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <string>

#include "kinfer/io/files/compressed_text.hpp"
#include "kinfer/io/files/text_file.hpp"
#include "kinfer/io/recording/foreign/foreign_log.hpp"
#include "kinfer/io/recording/foreign/ins_presets.hpp"
#include "kinfer/io/recording/foreign/log_bundle.hpp"
#include "kinfer/io/recording/ins_columns.hpp"
#include "kinfer/io/recording/ins_csv.hpp"
#include "kinfer/io/recording/ins_topics.hpp"
#include "kinfer/io/recording/possible_times.hpp"
#include "kinfer/io/robot_log/message_log_formats.hpp"
#include "kinfer/io/text/csv.hpp"

namespace kinfer {
namespace {

std::string unpacked_head(const std::filesystem::path& path) {
  constexpr std::size_t size = 1 << 16;
  const std::string head = read_head(path, size);
  return is_zstd(head) ? unpack_zstd_head(head, size) : head;
}

const RecordingFormat* recognised_format(const std::string& head) {
  const std::span<const RecordingFormat> formats = recording_formats();
  const auto row = std::ranges::find_if(formats, [&](const RecordingFormat& f) { return f.recognise(head); });
  return row == formats.end() ? nullptr : &*row;
}

Result<ForeignLog> read_foreign(const std::filesystem::path& path, const InsMap& map) {
  KINFER_TRY(text, read_text_file(path));
  return parse_foreign_log(text, path, map);
}

}  // namespace

std::span<const RecordingFormat> recording_formats() {
  static const std::array formats{
      RecordingFormat{.name = "CSV", .recognise = is_ins_csv, .append = append_ins_csv},
      RecordingFormat{.name = "robot log", .recognise = is_message_log, .append = append_all_ins_topics}};
  return formats;
}

bool is_recording(const std::filesystem::path& path) {
  if (is_message_log_file(path)) return true;
  if (is_log_bundle(path)) return true;  // reading it says what is in it
  const std::string head = unpacked_head(path);
  if (is_utf16(head)) return true;  // likewise
  return recognised_format(head) || find_preset(head, path) || is_foreign_log(head);
}

Result<InsRecording> read_recording(std::span<const std::filesystem::path> paths, std::span<const std::string> topics,
                                    const Observer& observer) {
  InsRecording recording;
  std::vector<ForeignLog> foreign;
  bool has_robot_log = false;
  for (const std::filesystem::path& path : paths) {
    if (is_message_log_file(path)) {
      has_robot_log = true;
      if (auto done = append_ins_topics(path, topics, recording, observer); !done) return forward_error(done.error());
      continue;
    }
    if (is_log_bundle(path)) {
      KINFER_TRY(logs, read_log_bundle(path));
      std::ranges::move(logs, std::back_inserter(foreign));
      continue;
    }
    const std::string head = unpacked_head(path);
    const RecordingFormat* format = recognised_format(head);
    const InsMap* preset = format ? nullptr : find_preset(head, path);
    if (preset || (!format && is_foreign_log(head))) {
      KINFER_TRY(log, read_foreign(path, preset ? *preset : InsMap{}));
      foreign.push_back(std::move(log));
      continue;
    }
    const auto done = (format ? format : &recording_formats().front())->append(path, recording, observer);
    if (!done) return forward_error(done.error());
  }
  if (!topics.empty() && !has_robot_log) return error("--topic: none of the files is a robot log, which has topics");
  if (auto done = append_foreign_logs(std::move(foreign), recording); !done) return forward_error(done.error());
  if (auto checked = check_times(recording); !checked) return forward_error(checked.error());
  return recording;
}

Result<InsRecording> read_mapped_recording(std::span<const std::filesystem::path> paths,
                                           const std::filesystem::path& map_path) {
  KINFER_TRY(map, read_ins_map(map_path));
  std::vector<ForeignLog> logs;
  for (const std::filesystem::path& path : paths) {
    KINFER_TRY(log, read_foreign(path, map));
    logs.push_back(std::move(log));
  }
  InsRecording recording;
  if (auto done = append_foreign_logs(std::move(logs), recording); !done) return forward_error(done.error());
  if (auto checked = check_times(recording); !checked) return forward_error(checked.error());
  return recording;
}

}  // namespace kinfer
