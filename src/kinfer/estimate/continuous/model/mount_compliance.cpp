// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/model/mount_compliance.hpp"

#include "kinfer/geometry/rotation_vector_motion.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;

void put(InsMountLoad::Rows& rows, std::size_t node, const VectorXd& value) {
  rows.row(static_cast<Index>(node)) = value.transpose().cast<float>();
}

}  // namespace

std::vector<InsMountLoad> mount_loads(const InsSensor& sensor, std::span<const double> time, const SplineGrid& grid) {
  std::vector<double> when;
  std::vector<Vec3> force;
  for (std::size_t row = 0; row < time.size(); ++row)
    if (const InsSample s = sample(sensor, time, row); s.has_acceleration) {
      when.push_back(time[row]);
      force.push_back(s.acceleration);
    }
  std::vector<InsMountLoad> mount_load(static_cast<std::size_t>(grid.intervals));
  if (when.empty()) return mount_load;
  MatrixXd values(static_cast<Index>(force.size()), 3);
  for (std::size_t i = 0; i < force.size(); ++i) values.row(static_cast<Index>(i)) = force[i].transpose();
  const Eigen::RowVector3d mean = values.colwise().mean();
  values.rowwise() -= mean;
  const MatrixXd coefficients = fit_spline(grid, when, values);
  for (std::size_t k = 0; k < mount_load.size(); ++k)
    for (std::size_t node = 0; node < block_nodes; ++node) {
      const double at = grid.begin + grid.period * (static_cast<double>(k) + block_nodes_u()[node]);
      put(mount_load[k].force, node, spline_value(grid, coefficients, at));
      put(mount_load[k].change, node, spline_value(grid, coefficients, at, 1));
    }
  return mount_load;
}

InsState state_on_mount(const InsState& segment, const Mat3& tilt, const Vec3& force, const Vec3& force_change) {
  const Vec3 turned = tilt * force;
  const Mat3 back = exp_so3(-turned);
  InsState state = segment;
  state.angular_velocity = back * segment.angular_velocity + right_jacobian(turned) * (tilt * force_change);
  state.force = back * segment.force;
  return state;
}

MountDerivative state_on_mount_derivative(const InsState& segment, const Mat3& tilt, const Vec3& force,
                                          const Vec3& force_change) {
  const Vec3 turned = tilt * force;
  MountDerivative d;
  d.turn = exp_so3(-turned);
  d.state = segment;
  const RotationVectorMotion own = rotation_vector_motion(turned, tilt * force_change, Vec3::Zero());
  const Vec3 angular_velocity = d.turn * segment.angular_velocity;
  d.state.angular_velocity = angular_velocity + own.angular_velocity;
  d.state.force = d.turn * segment.force;
  const Mat3 velocity_by_rotation = skew(angular_velocity) * own.jacobian + own.velocity_by_vector;
  const Mat3 force_by_turn = skew(d.state.force) * own.jacobian;
  for (Index j = 0; j < 3; ++j) {
    d.velocity_by_tilt.middleCols<3>(3 * j) = force[j] * velocity_by_rotation + force_change[j] * own.jacobian;
    d.force_by_tilt.middleCols<3>(3 * j) = force[j] * force_by_turn;
  }
  return d;
}

}  // namespace kinfer
