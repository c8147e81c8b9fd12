// SPDX-License-Identifier: Apache-2.0
// File formats of robot logs: a table with one row per format, recognised by the beginning of the file.
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "kinfer/base/result.hpp"
#include "kinfer/io/robot_log/message_log.hpp"

namespace kinfer {

struct MessageLogFormat {
  std::string_view name;  ///< "MCAP"
  bool (*recognise)(std::string_view head) = nullptr;
  Result<MessageLog> (*read)(const std::filesystem::path& path, const MessageSink& sink) = nullptr;
};

/// The table: one row a format.
std::span<const MessageLogFormat> message_log_formats();

/// Whether the beginning of a file is that of some message log.
bool is_message_log(std::string_view head);

/// Whether the file, or the files of the folder, is a message log.
bool is_message_log_file(const std::filesystem::path& path);

/// Reads a file of any of the formats, or a folder of a ROS 2 bag.
Result<MessageLog> read_message_log(const std::filesystem::path& path, const MessageSink& sink);

}  // namespace kinfer
