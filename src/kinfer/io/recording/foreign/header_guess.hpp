// SPDX-License-Identifier: Apache-2.0
// What the header of a foreign log says by itself: which columns are accelerometer, gyroscope and magnetometer, of
// which sensor, and which is the clock. "IMU2 Acc_X (g)", "Gyroscope y (rad/s)", "X Accel [x8004]", "boom_gz".
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kinfer {

enum class ChannelKind { other, time, force, rate, field, free_acceleration };

struct GuessedColumn {
  ChannelKind kind = ChannelKind::other;
  std::size_t axis = 0;
  std::string sensor;  ///< what remains of the name; empty where it names no sensor
};

/// `name`: a column's name without its unit.
GuessedColumn guess_column(std::string_view name);

}  // namespace kinfer
