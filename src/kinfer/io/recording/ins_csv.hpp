// SPDX-License-Identifier: Apache-2.0
// INS recordings as CSV (docs/formats.md): a time column t, then SENSOR_CHANNEL columns with channel ax ay az (specific
// force), gx gy gz (angular rate), mx my mz (magnetic field). One pass over the mapped file, straight into columns.
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "kinfer/base/observer.hpp"
#include "kinfer/base/result.hpp"
#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer {

/// Reads one log or several, one per logger, each with its own clock. Anomalies that leave the data usable become
/// remarks of the recording; values that are impossible in the unit that the file states are an error.
Result<InsRecording> read_ins_csv(std::span<const std::filesystem::path> paths);
Result<InsRecording> read_ins_csv(const std::filesystem::path& path);

/// Adds the file's logger and sensors to `recording`.
Result<void> append_ins_csv(const std::filesystem::path& path, InsRecording& recording, const Observer& observer = {});

/// The same from the text of one log.
Result<InsRecording> parse_ins_csv(std::string_view text, const std::string& name_in_messages);

}  // namespace kinfer
