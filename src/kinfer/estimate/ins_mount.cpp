#include "kinfer/estimate/ins_mount.hpp"

#include "kinfer/estimate/rotation_rate.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;

void put(InsBending::Rows& rows, std::size_t node, const VectorXd& value) {
  rows.row(static_cast<Index>(node)) = value.transpose().cast<float>();
}

}  // namespace

std::vector<InsBending> mount_bending(const InsSensor& sensor, std::span<const double> time, const SplineGrid& grid) {
  std::vector<double> when;
  std::vector<Vec3> force;
  for (std::size_t row = 0; row < time.size(); ++row)
    if (const InsSample s = sample(sensor, time, row); s.has_acceleration) {
      when.push_back(time[row]);
      force.push_back(s.acceleration);
    }
  std::vector<InsBending> bending(static_cast<std::size_t>(grid.intervals));
  if (when.empty()) return bending;
  MatrixXd values(static_cast<Index>(force.size()), 3);
  for (std::size_t i = 0; i < force.size(); ++i) values.row(static_cast<Index>(i)) = force[i].transpose();
  const Eigen::RowVector3d mean = values.colwise().mean();
  values.rowwise() -= mean;
  const MatrixXd band = fit_spline(grid, when, values);
  for (std::size_t k = 0; k < bending.size(); ++k)
    for (std::size_t node = 0; node < block_nodes; ++node) {
      const double at = grid.begin + grid.period * (static_cast<double>(k) + block_places()[node]);
      put(bending[k].force, node, spline_value(grid, band, at));
      put(bending[k].change, node, spline_value(grid, band, at, 1));
    }
  return bending;
}

InsState felt(const InsState& segment, const Mat3& tilt, const Vec3& force, const Vec3& force_change) {
  const Vec3 turned = tilt * force;
  const Mat3 back = exp_so3(-turned);
  InsState state = segment;
  state.rate = back * segment.rate + right_jacobian(turned) * (tilt * force_change);
  state.force = back * segment.force;
  state.field = back * segment.field;
  return state;
}

FeltDerivative felt_derivative(const InsState& segment, const Mat3& tilt, const Vec3& force, const Vec3& force_change) {
  const Vec3 turned = tilt * force;
  FeltDerivative d;
  d.turn = exp_so3(-turned);
  d.state = segment;
  const RotationRate own = rotation_rate(turned, tilt * force_change, Vec3::Zero());
  const Vec3 rate = d.turn * segment.rate;
  d.state.rate = rate + own.rate;
  d.state.force = d.turn * segment.force;
  d.state.field = d.turn * segment.field;
  const Mat3 rate_by_turn = skew(rate) * own.jacobian + own.rate_by_vector;
  const Mat3 force_by_turn = skew(d.state.force) * own.jacobian, field_by_turn = skew(d.state.field) * own.jacobian;
  for (Index j = 0; j < 3; ++j) {
    d.rate_by_tilt.middleCols<3>(3 * j) = force[j] * rate_by_turn + force_change[j] * own.jacobian;
    d.force_by_tilt.middleCols<3>(3 * j) = force[j] * force_by_turn;
    d.field_by_tilt.middleCols<3>(3 * j) = force[j] * field_by_turn;
  }
  return d;
}

}  // namespace kinfer
