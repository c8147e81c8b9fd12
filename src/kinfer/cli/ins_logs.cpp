#include "kinfer/cli/ins_logs.hpp"

#include <filesystem>

#include "kinfer/io/ins_csv.hpp"

namespace kinfer::cli {

Result<InsRecording> read_ins_logs(const std::vector<std::string>& files) {
  const std::vector<std::filesystem::path> paths(files.begin(), files.end());
  KINFER_TRY(recording, read_ins_csv(paths));
  for (const InsSensor& sensor : recording.sensors)
    if (!sensor.acceleration.present() || !sensor.rate.present())
      return error("{}: identification needs its specific force (ax ay az) and its angular rate (gx gy gz)",
                   sensor.name);
  return recording;
}

}  // namespace kinfer::cli
