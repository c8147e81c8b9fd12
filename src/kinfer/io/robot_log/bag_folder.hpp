// SPDX-License-Identifier: Apache-2.0
// A ROS 2 bag as a folder: metadata.yaml and its files, each a part of the recording.
#pragma once

#include <filesystem>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/io/robot_log/message_log.hpp"

namespace kinfer {

/// The .mcap and .db3 files of the folder, by the numbers in their names; metadata.yaml is not needed. Empty: no bag.
std::vector<std::filesystem::path> bag_folder_files(const std::filesystem::path& folder);

using ReadLog = Result<MessageLog> (*)(const std::filesystem::path& path, const MessageSink& sink);

/// All files of a bag as one log; topics of one name are one topic.
Result<MessageLog> read_bag_files(const std::vector<std::filesystem::path>& files, const MessageSink& sink,
                                  ReadLog read);

}  // namespace kinfer
