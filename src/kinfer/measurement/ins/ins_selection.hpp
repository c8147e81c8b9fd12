// SPDX-License-Identifier: Apache-2.0
// Part of a recording: selected sensors, or a time segment.
#pragma once

#include "kinfer/base/result.hpp"
#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer {

/// Only these sensors, in this order, with the loggers that they need.
InsRecording select_sensors(const InsRecording& recording, const std::vector<std::size_t>& sensors);

/// Indices of the named sensors; an error for an unknown name.
Result<std::vector<std::size_t>> find_sensors(const InsRecording& recording, const std::vector<std::string>& names);

/// Only the rows from `begin` to `end` [s].
InsRecording within(const InsRecording& recording, double begin, double end);

}  // namespace kinfer
