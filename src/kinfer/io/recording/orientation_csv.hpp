// SPDX-License-Identifier: Apache-2.0
// Orientations as CSV (docs/formats.md, `orient`): t, then SENSOR_qw, SENSOR_qx, SENSOR_qy, SENSOR_qz, sensor to world.
#pragma once

#include <filesystem>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/measurement/ins/ins_recording.hpp"
#include "kinfer/measurement/ins/sensor_orientations.hpp"

namespace kinfer {

/// One row per input row, logger after logger, each with its own clock; sensors of another logger have empty cells. The
/// file is written completely or not at all.
Result<void> write_orientation_csv(const std::filesystem::path& path, const InsRecording& recording,
                                   const std::vector<SensorOrientations>& orientations);

}  // namespace kinfer
