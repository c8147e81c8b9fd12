// Part of a recording: some of its sensors, or some of its time.
#pragma once

#include "kinfer/base/result.hpp"
#include "kinfer/measurement/ins_recording.hpp"

namespace kinfer {

/// Only these sensors, in this order, with the loggers that they need.
InsRecording with_sensors(const InsRecording& recording, const std::vector<std::size_t>& sensors);

/// Indices of the named sensors; an error for an unknown name.
Result<std::vector<std::size_t>> sensors_named(const InsRecording& recording, const std::vector<std::string>& names);

/// Only the rows from `begin` to `end` [s].
InsRecording within(const InsRecording& recording, double begin, double end);

}  // namespace kinfer
