// SPDX-License-Identifier: Apache-2.0
#include "kinfer/simulate/machine_motion.hpp"

#include <cmath>

namespace kinfer {

std::size_t row_count(double duration, double sampling_rate) {
  return static_cast<std::size_t>(std::llround(duration * sampling_rate));
}

MachineMotion make_motion(const Machine& machine, std::size_t rows, double sampling_rate) {
  MachineMotion motion;
  motion.time.resize(rows);
  for (std::size_t row = 0; row < rows; ++row) motion.time[row] = static_cast<double>(row) / sampling_rate;
  motion.q = motion.qd = motion.qdd = MatrixXd::Zero(dof(machine.chain), static_cast<Eigen::Index>(rows));
  motion.sensors.resize(machine.sensors.size());
  for (SensorMotion& sensor : motion.sensors) {
    sensor.world_R_sensor.resize(rows);
    for (auto* column : {&sensor.position, &sensor.force, &sensor.angular_velocity, &sensor.field})
      column->resize(rows);
  }
  return motion;
}

}  // namespace kinfer
