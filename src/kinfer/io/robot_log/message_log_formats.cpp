// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot_log/message_log_formats.hpp"

#include <algorithm>
#include <array>

#include "kinfer/io/files/text_file.hpp"
#include "kinfer/io/robot_log/bag_folder.hpp"
#include "kinfer/io/robot_log/bag_reader.hpp"
#include "kinfer/io/robot_log/db3_reader.hpp"
#include "kinfer/io/robot_log/mcap_reader.hpp"

namespace kinfer {

std::span<const MessageLogFormat> message_log_formats() {
  static constexpr std::array formats{
      MessageLogFormat{.name = "MCAP", .recognise = is_mcap, .read = read_mcap},
      MessageLogFormat{.name = "ROS 1 bag", .recognise = is_bag, .read = read_bag},
      MessageLogFormat{.name = "ROS 2 db3", .recognise = is_db3, .read = read_db3},
  };
  return formats;
}

bool is_message_log(std::string_view head) {
  return std::ranges::any_of(message_log_formats(), [&](const MessageLogFormat& f) { return f.recognise(head); });
}

namespace {

constexpr std::size_t head_size = 64;

Result<MessageLog> read_one_file(const std::filesystem::path& path, const MessageSink& sink) {
  const std::string head = read_head(path, head_size);
  for (const MessageLogFormat& format : message_log_formats())
    if (format.recognise(head)) return format.read(path, sink);
  return error("{}: no robot log; known are .mcap, ROS 1 .bag (2.0) and ROS 2 .db3", path.string());
}

}  // namespace

bool is_message_log_file(const std::filesystem::path& path) {
  std::error_code failure;
  if (std::filesystem::is_directory(path, failure)) return !bag_folder_files(path).empty();
  return is_message_log(read_head(path, head_size));
}

Result<MessageLog> read_message_log(const std::filesystem::path& path, const MessageSink& sink) {
  std::error_code failure;
  if (!std::filesystem::is_directory(path, failure)) return read_one_file(path, sink);
  const std::vector<std::filesystem::path> files = bag_folder_files(path);
  if (files.empty())
    return error(
        "{}: the folder holds no .mcap and no .db3 file; is the bag compressed as files (.zstd)? "
        "ros2 bag convert unpacks it",
        path.string());
  return read_bag_files(files, sink, read_one_file);
}

}  // namespace kinfer
