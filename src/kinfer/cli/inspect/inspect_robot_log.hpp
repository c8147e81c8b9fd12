// SPDX-License-Identifier: Apache-2.0
// The topics of a robot log, and what each could be used for.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "kinfer/base/result.hpp"
#include "kinfer/io/robot_log/message_log.hpp"

namespace kinfer::cli {

bool is_robot_log(const std::string& file);

Result<MessageLog> read_topics(const std::string& file);
bool has_imu(const MessageLog& log);

/// [{topic, type, messages, rate_hz, use}]
nlohmann::ordered_json topics_json(const MessageLog& log);

/// As a table, with the reader's remarks.
void print_topics(const std::string& file, const MessageLog& log);

}  // namespace kinfer::cli
