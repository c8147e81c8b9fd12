// SPDX-License-Identifier: Apache-2.0
// What a reader of INS logs says about the sensors and times that it has read.
#pragma once

#include <array>
#include <span>
#include <string>

#include "kinfer/base/result.hpp"
#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer {

/// Marks faults and adds remarks for the sensors from `first` on; `stated`: whether the file states the unit of each
/// instrument of each of them. An error where values are impossible in the unit that the file states, or in any.
Result<void> screen_sensors(InsRecording& out, std::size_t first, const std::string& name,
                            std::span<const std::array<bool, 3>> stated);

/// About a logger: a single row, gaps.
void add_time_remarks(InsRecording& out, std::size_t logger, const std::string& name);

}  // namespace kinfer
