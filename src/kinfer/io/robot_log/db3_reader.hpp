// SPDX-License-Identifier: Apache-2.0
// ROS 2 bags stored by SQLite (.db3): tables `topics` and `messages`, and in newer ones `message_definitions`.
#pragma once

#include <filesystem>

#include "kinfer/base/result.hpp"
#include "kinfer/io/robot_log/message_log.hpp"

namespace kinfer {

/// Any SQLite file; one without those tables is an error of the reader.
bool is_db3(std::string_view head);
Result<MessageLog> read_db3(const std::filesystem::path& path, const MessageSink& sink);

}  // namespace kinfer
