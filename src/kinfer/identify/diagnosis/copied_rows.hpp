// SPDX-License-Identifier: Apache-2.0
// A log that was joined with itself, or with a copy of a part: the same measurements would count twice. Noise never
// repeats: a stretch of changing rows, equal in every instrument of every sensor, was copied.
#pragma once

#include "kinfer/base/result.hpp"
#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer::identify {

/// An error where more than max_copied_share of a logger's rows are copies of earlier ones.
Result<void> refuse_copied_rows(const InsRecording& recording);

}  // namespace kinfer::identify
