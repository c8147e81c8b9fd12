// INS recordings as a verb that identifies takes them.
#pragma once

#include <string>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/measurement/ins_recording.hpp"

namespace kinfer::cli {

/// All files as one recording. An error where a sensor lacks its specific force or its angular rate.
Result<InsRecording> read_ins_logs(const std::vector<std::string>& paths);

}  // namespace kinfer::cli
