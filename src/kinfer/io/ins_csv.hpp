// INS recordings as CSV (docs/formats.md): a time column t, then SENSOR_CHANNEL columns with channel ax ay az (specific
// force), gx gy gz (angular rate), mx my mz (magnetic field). One pass over the mapped file, straight into columns.
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "kinfer/base/result.hpp"
#include "kinfer/measurement/ins_recording.hpp"

namespace kinfer {

/// Reads one log, or several, one a logger with a clock of its own. What is odd but can be used is a remark of the
/// recording; numbers that cannot be in the unit that the file claims are an error.
Result<InsRecording> read_ins_csv(std::span<const std::filesystem::path> paths);
Result<InsRecording> read_ins_csv(const std::filesystem::path& path);

/// The same from text, as one logger.
Result<InsRecording> parse_ins_csv(std::string_view text, const std::string& name_in_messages);

/// Whether a header names the columns of an INS recording (t and at least one SENSOR_ax), so that `inspect` knows.
bool looks_like_ins_csv(std::string_view text);

}  // namespace kinfer
