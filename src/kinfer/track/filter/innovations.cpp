// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/filter/innovations.hpp"

#include <cmath>

#include "kinfer/geometry/rotation.hpp"

namespace kinfer::track {

double squared_distance(SensorVector v, SensorMatrix m) {
  double t = 0.0;
  for (Index k = 0; k < sensor_rows; ++k) {  // by elimination
    t += v[k] * v[k] / m(k, k);
    for (Index i = k + 1; i < sensor_rows; ++i) {
      const double factor = m(i, k) / m(k, k);
      v[i] -= factor * v[k];
      for (Index j = k + 1; j < sensor_rows; ++j) m(i, j) -= factor * m(k, j);
    }
  }
  return t;
}

Innovations::Innovations(const FilterModel& model) {
  const auto sensors = static_cast<std::size_t>(model.layout.sensors);
  value = VectorXd::Zero(model.layout.rows());
  leave_out.assign(sensors, 0.0);
  rows.assign(sensors, 0);
  lateness.assign(sensors, {});
  turn.assign(sensors, {});
  of_joint.assign(model.joints.size(), 0.0);
  unlimited = leave_out;
  unlimited_of_joint = of_joint;
  of_instrument.assign(2 * sensors, 1.0);
}

void examine_sensors(const UpdateSystem& system, const std::vector<bool>& is_used, const ChainMeasurement& predicted,
                     const VectorXd& change, Innovations& innovations) {
  innovations.log_likelihood = -0.5 * system.whitened().squaredNorm() - system.log_root_determinant();
  for (std::size_t s = 0; s < is_used.size(); ++s) {
    const Index row = sensor_rows * static_cast<Index>(s);
    innovations.rows[s] = (system.is_measured()[2 * s] ? 3 : 0) + (system.is_measured()[2 * s + 1] ? 3 : 0);
    if (!is_used[s]) continue;
    SensorMatrix own;
    SensorVector u;
    for (Index i = 0; i < sensor_rows; ++i) {
      u[i] = system.inverse().col(row + i).dot(system.whitened());
      for (Index j = 0; j <= i; ++j)
        own(i, j) = own(j, i) = system.inverse().col(row + i).dot(system.inverse().col(row + j));
    }
    for (Index i = 0; i < sensor_rows; ++i)
      if (!system.is_measured()[2 * s + static_cast<std::size_t>(i / 3)]) u[i] = 0.0;
    innovations.leave_out[s] = squared_distance(u, own);
    const SensorVector by_lateness = -change.segment<sensor_rows>(row);
    innovations.lateness[s] = {by_lateness.dot(u), by_lateness.dot(own * by_lateness)};
    Eigen::Matrix<double, sensor_rows, 3> by_turn;
    by_turn << -skew(predicted.angular_velocity[s]), -skew(predicted.force[s]);
    innovations.turn[s] = {by_turn.transpose() * u, by_turn.transpose() * own * by_turn};
    for (Index half = 0; half < 2; ++half) {
      const Vec3 v = u.segment<3>(3 * half);
      const Mat3 w = own.block<3, 3>(3 * half, 3 * half);
      innovations.of_instrument[2 * s + static_cast<std::size_t>(half)] = v.dot(w.inverse() * v) / 3.0;
    }
  }
}

}  // namespace kinfer::track
