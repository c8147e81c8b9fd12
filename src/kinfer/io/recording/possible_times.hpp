// SPDX-License-Identifier: Apache-2.0
// Are the times of a recording those of an INS? Times in milliseconds that are read as seconds, or one row that is
// years later, would make a grid that no memory holds.
#pragma once

#include <span>
#include <string>

#include "kinfer/base/result.hpp"
#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer {

/// An error that names the logger whose rows are too far apart or too close, or that spans far more time than it has
/// rows for. A unit that its file does not state may be another than seconds: who diagnoses the log converts it.
Result<void> check_times(const InsRecording& recording);

/// Of a recording that nobody diagnoses: an error, too, if the times of a logger are in another unit than seconds.
Result<void> expect_seconds(const InsRecording& recording);
Result<void> expect_seconds(std::span<const double> time, const std::string& logger);

}  // namespace kinfer
