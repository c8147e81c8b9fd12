// How a machine moved and what perfect sensors on it said: the truth behind a simulated recording.
#pragma once

#include <vector>

#include "kinfer/simulate/machine.hpp"

namespace kinfer {

/// What one perfect INS says, and where it is; one entry a row.
struct SensorMotion {
  std::vector<Quat> world_R_sensor;
  std::vector<Vec3> position;  ///< [m] in the world
  std::vector<Vec3> force;     ///< [m/s²] specific force in the sensor's frame: +g upward at rest
  std::vector<Vec3> rate;      ///< [rad/s] in the sensor's frame
  std::vector<Vec3> field;     ///< [µT] in the sensor's frame
};

struct MachineMotion {
  std::vector<double> time;           ///< [s], one a row
  MatrixXd q, qd, qdd;                ///< readings x rows: [rad] or [m], per second, per second²
  std::vector<SensorMotion> sensors;  ///< in the order of Machine::sensors
};

/// An empty motion with room for `rows` rows at `sampling_rate` [Hz] from t = 0 on.
MachineMotion make_motion(const Machine& machine, std::size_t rows, double sampling_rate);

/// Number of rows of a recording of `duration` [s].
std::size_t row_count(double duration, double sampling_rate);

/// World East-North-Up, as the machines' files have it.
inline const Vec3 magnetic_field_world(1.5, 20.5, -44.0);  // [µT]

}  // namespace kinfer
