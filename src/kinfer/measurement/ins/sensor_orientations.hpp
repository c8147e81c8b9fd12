// SPDX-License-Identifier: Apache-2.0
// Orientations of one sensor of a recording, row by row.
#pragma once

#include <cstddef>
#include <vector>

#include "kinfer/geometry/rotation.hpp"

namespace kinfer {

struct SensorOrientations {
  std::size_t sensor = 0;              ///< index in the recording
  std::vector<Quat> world_q_sensor{};  ///< sensor to world (x east, y north, z up), one per row of its logger
  bool heading_is_north = false;       ///< from the magnetometer; else relative to the start
  double rest_seconds = 0.0;           ///< [s] of rest, from which the gyro bias is known; 0: from the motion alone
};

}  // namespace kinfer
