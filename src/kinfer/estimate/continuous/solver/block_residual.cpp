// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/solver/block_residual.hpp"

#include <cmath>

#include "kinfer/estimate/continuous/model/mount_compliance.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;

Vec3 read_gyroscope(const InsState& s, const InsErrors& e) {
  return s.angular_velocity + e.gyroscope_scale * s.angular_velocity + e.gyroscope_bias;
}
Vec3 read_accelerometer(const InsState& s, const InsErrors& e) {
  return s.force + e.accelerometer_scale * s.force + e.accelerometer_bias;
}

}  // namespace

double from_middle(const SplineGrid& grid, Index interval) {
  return grid.period * (static_cast<double>(interval) + 0.5 - 0.5 * static_cast<double>(grid.intervals));
}

BlockResidual residual(const InsBlock& block, const NodeMatrix& factor, const BlockResidual& predicted, double sd) {
  return (block.target.cast<double>() - factor * predicted) / sd;
}

double clock_shift(const InsProblem& problem, const InsLayout& layout, const InsErrors& errors, Index interval) {
  if (!layout.has_clocks) return 0.0;
  return (errors.clock.offset + errors.clock.drift * from_middle(problem.grid, interval)) / problem.grid.period;
}

NodeMatrix shifted_factor(const InsBlock& block, const InsLayout& layout, double shift) {
  if (!layout.has_clocks) return block.factor.cast<double>();
  return block.factor.cast<double>() * (NodeMatrix::Identity() + shift * node_derivative());
}

RobustBlock robust(double squares, double terms) {
  const double limit = terms + 4.0 * std::sqrt(2.0 * terms);
  if (squares <= limit) return {squares, 1.0};
  if (!std::isfinite(squares)) return {1e300, 0.0};
  return {limit * (1.0 + std::log(squares / limit)), limit / squares};
}

std::vector<InstrumentMeasurements> instruments(const InsProblem& problem, std::size_t sensor) {
  const InsMeasurements& r = problem.sensors[sensor];
  std::vector<InstrumentMeasurements> uses{{r.angular_velocity, r.noise.angular_velocity, read_gyroscope, rate_row},
                                           {r.force, r.noise.force, read_accelerometer, force_row}};
  if (!r.clipped_rate.empty())
    uses.push_back({r.clipped_rate.blocks, r.noise.angular_velocity, read_gyroscope, rate_row, &r.clipped_rate.sides});
  if (!r.clipped_force.empty())
    uses.push_back({r.clipped_force.blocks, r.noise.force, read_accelerometer, force_row, &r.clipped_force.sides});
  return uses;
}

void drop_satisfied(BlockResidual& residual, const InstrumentMeasurements& instrument, Index interval) {
  if (!instrument.is_bound()) return;
  const auto& sides = (*instrument.sides)[static_cast<std::size_t>(interval)];
  for (Index i = 0; i < residual.rows(); ++i)
    for (Index axis = 0; axis < 3; ++axis)
      if (is_satisfied(sides[static_cast<std::size_t>(i)][static_cast<std::size_t>(axis)], residual(i, axis)))
        residual(i, axis) = 0.0;
}

InsState sensor_state_at(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x, std::size_t sensor,
                         Index interval, std::size_t node, const InsState& segment) {
  if (!layout.has_tilts) return segment;
  const InsMountLoad& mount_load = problem.sensors[sensor].mount_load[static_cast<std::size_t>(interval)];
  return state_on_mount(segment, x.errors[sensor].tilt, mount_load.force_at(node), mount_load.change_at(node));
}

}  // namespace kinfer
