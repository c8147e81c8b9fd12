// SPDX-License-Identifier: Apache-2.0
// `kinfer inspect` for joint logs and tracker files of other programs.
#pragma once

#include <string>

namespace kinfer::cli {

/// Whether the file is of a format that kinfer pair knows by itself.
bool is_pose_log(const std::string& file);

/// Prints format, contents and size; an exit code.
int inspect_pose_log(const std::string& file, bool json);

}  // namespace kinfer::cli
