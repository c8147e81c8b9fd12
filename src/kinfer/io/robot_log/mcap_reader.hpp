// SPDX-License-Identifier: Apache-2.0
// MCAP files (mcap.dev/spec): records one after the other, many of them inside compressed chunks. Read from the start,
// without the index, so that a file whose recorder was switched off is read as far as it goes.
#pragma once

#include <filesystem>

#include "kinfer/base/result.hpp"
#include "kinfer/io/robot_log/message_log.hpp"

namespace kinfer {

bool is_mcap(std::string_view head);
Result<MessageLog> read_mcap(const std::filesystem::path& path, const MessageSink& sink);

}  // namespace kinfer
