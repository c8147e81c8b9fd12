// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/parts/ins_logs.hpp"

#include <filesystem>

#include "kinfer/io/recording/recording_formats.hpp"

namespace kinfer::cli {

Result<InsRecording> read_ins_logs(const std::vector<std::string>& files) {
  const std::vector<std::filesystem::path> paths(files.begin(), files.end());
  return read_recording(paths);
}

}  // namespace kinfer::cli
