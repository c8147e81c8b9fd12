// SPDX-License-Identifier: Apache-2.0
// Are the times of a recording those of an INS? Times in milliseconds that are read as seconds, or one row that is
// years later, would make a grid that no memory holds.
#pragma once

#include "kinfer/base/result.hpp"
#include "kinfer/measurement/ins_recording.hpp"

namespace kinfer {

/// An error that names the logger whose rows are too far apart or too close, or that spans far more time than it has
/// rows for.
Result<void> check_times(const InsRecording& recording);

}  // namespace kinfer
