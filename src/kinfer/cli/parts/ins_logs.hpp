// SPDX-License-Identifier: Apache-2.0
// Input of the verbs that identify: INS recordings.
#pragma once

#include <string>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/measurement/ins_recording.hpp"

namespace kinfer::cli {

/// All files as one recording. An error if a sensor lacks specific force or angular rate.
Result<InsRecording> read_ins_logs(const std::vector<std::string>& paths);

}  // namespace kinfer::cli
