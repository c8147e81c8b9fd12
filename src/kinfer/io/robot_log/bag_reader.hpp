// SPDX-License-Identifier: Apache-2.0
// ROS 1 bags, version 2.0 (wiki.ros.org/Bags/Format/2.0): records of a header with named fields and data, many of them
// inside compressed chunks. Read from the start, without the index.
#pragma once

#include <filesystem>

#include "kinfer/base/result.hpp"
#include "kinfer/io/robot_log/message_log.hpp"

namespace kinfer {

bool is_bag(std::string_view head);
Result<MessageLog> read_bag(const std::filesystem::path& path, const MessageSink& sink);

}  // namespace kinfer
