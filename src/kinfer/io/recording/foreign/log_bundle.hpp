// SPDX-License-Identifier: Apache-2.0
// Logs that come together: a zip archive or a folder with one file an instrument, as phones export them.
#pragma once

#include <filesystem>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/io/recording/foreign/foreign_log.hpp"

namespace kinfer {

/// Whether the path is a folder, or a file that is a zip archive.
bool is_log_bundle(const std::filesystem::path& path);

/// The logs among the files of a folder or an archive, which must not lead out of it. Files that are no logs are passed
/// over, those that a preset refuses too, with a remark; an error where none is left.
Result<std::vector<ForeignLog>> read_log_bundle(const std::filesystem::path& path);

}  // namespace kinfer
