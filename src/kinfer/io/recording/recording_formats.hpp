// SPDX-License-Identifier: Apache-2.0
// File formats of INS recordings: a table with one row per format, recognised by the beginning of the file.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "kinfer/base/observer.hpp"
#include "kinfer/base/result.hpp"
#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer {

struct RecordingFormat {
  std::string_view name;                               ///< "CSV"
  bool (*recognise)(std::string_view head) = nullptr;  ///< `head`: the first 64 KiB of the file, or all of it
  /// Adds the file's logger and sensors to `recording`.
  Result<void> (*append)(const std::filesystem::path& path, InsRecording& recording,
                         const Observer& observer) = nullptr;
};

/// The table. Files that no format recognises are read as the first format, whose errors say what is expected.
std::span<const RecordingFormat> recording_formats();

/// Whether some format recognises the file, or a preset, or its header speaks for itself. Folders and zip archives are
/// taken for recordings; reading them says what is in them.
bool is_recording(const std::filesystem::path& path);

/// Reads one log or several, one per logger, each with its own clock and possibly of different formats. Logs of other
/// programs are read by their preset, or by what their headers say; the instruments of one sensor may be in several
/// files, in a folder or in a zip archive. `topics`: of robot logs; all Imu topics where empty.
Result<InsRecording> read_recording(std::span<const std::filesystem::path> paths,
                                    std::span<const std::string> topics = {}, const Observer& observer = {});

/// The same with a column map for all files (docs/formats.md).
Result<InsRecording> read_mapped_recording(std::span<const std::filesystem::path> paths,
                                           const std::filesystem::path& map);

}  // namespace kinfer
