// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot_log/message_log_formats.hpp"

#include <algorithm>
#include <array>
#include <fstream>

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

Result<MessageLog> read_message_log(const std::filesystem::path& path, const MessageSink& sink) {
  std::ifstream file(path, std::ios::binary);
  std::string head(64, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));
  for (const MessageLogFormat& format : message_log_formats())
    if (format.recognise(head)) return format.read(path, sink);
  return error("{}: no robot log; known are .mcap, ROS 1 .bag (2.0) and ROS 2 .db3", path.string());
}

}  // namespace kinfer
