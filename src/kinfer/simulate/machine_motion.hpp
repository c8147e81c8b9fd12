// SPDX-License-Identifier: Apache-2.0
// The motion of a machine and the signals of ideal sensors on it: ground truth of a simulated recording.
#pragma once

#include <vector>

#include "kinfer/simulate/machine.hpp"

namespace kinfer {

/// Signals and pose of one ideal INS; one entry per row.
struct SensorMotion {
  std::vector<Quat> world_R_sensor;
  std::vector<Vec3> position;          ///< [m] in the world
  std::vector<Vec3> force;             ///< [m/s²] specific force in the sensor's frame: +g upward at rest
  std::vector<Vec3> angular_velocity;  ///< [rad/s] in the sensor's frame
  std::vector<Vec3> field;             ///< [µT] in the sensor's frame
};

struct MachineMotion {
  std::vector<double> time;           ///< [s], one per row
  MatrixXd q, qd, qdd;                ///< dof x rows: [rad] or [m], per second, per second²
  std::vector<SensorMotion> sensors;  ///< in the order of Machine::sensors
};

/// An empty motion with room for `rows` rows at `sampling_rate` [Hz] from t = 0 on.
MachineMotion make_motion(const Machine& machine, std::size_t rows, double sampling_rate);

/// Number of rows of a recording of `duration` [s].
std::size_t row_count(double duration, double sampling_rate);

/// In the world frame, East-North-Up, as in the machines' files.
inline const Vec3 magnetic_field_world(1.5, 20.5, -44.0);  // [µT]

}  // namespace kinfer
