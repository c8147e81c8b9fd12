// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/parts/ins_logs.hpp"

#include <filesystem>

#include "kinfer/io/recording/recording_formats.hpp"

namespace kinfer::cli {

Result<InsRecording> read_ins_logs(const std::vector<std::string>& files) {
  const std::vector<std::filesystem::path> paths(files.begin(), files.end());
  KINFER_TRY(recording, read_recording(paths));
  for (const InsSensor& sensor : recording.sensors)
    if (!sensor.acceleration.present() || !sensor.angular_velocity.present())
      return error("{}: identification needs specific force (ax ay az) and angular rate (gx gy gz)", sensor.name);
  return recording;
}

}  // namespace kinfer::cli
