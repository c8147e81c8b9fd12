#include "kinfer/estimate/ins_sensor_system.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/estimate/ins_mount.hpp"
#include "kinfer/estimate/ins_residual.hpp"
#include "kinfer/estimate/ins_wander.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;

/// By the numbers of the tilt, of what one instrument feels.
const Eigen::Matrix<double, 3, 9>& by_tilt(const FeltDerivative& felt, const InstrumentUse& use) {
  return use.state_row == 0 ? felt.rate_by_tilt : use.state_row == 6 ? felt.force_by_tilt : felt.field_by_tilt;
}

/// Derivative of one instrument's reading at one node by the columns of the sensor (3 rows).
template <class Rows>
void fill_rows(Rows rows, const InstrumentUse& use, const InsLayout& layout, const SensorColumns& columns,
               const std::vector<InsColumn>& path, const StateColumns& state_columns, const FeltDerivative& felt,
               const InsErrors& errors, const SplineBasis& basis) {
  rows.setZero();
  const InsState& state = felt.state;
  Eigen::Matrix<double, 3, Eigen::Dynamic> by_state = state_columns.middleRows<3>(use.state_row);
  if (layout.has_tilts) by_state = (felt.turn * by_state).eval();
  if (layout.has_matrices && use.state_row == 0) by_state = (by_state + errors.rate_matrix * by_state).eval();
  if (layout.has_matrices && use.state_row == 6) by_state = (by_state + errors.force_matrix * by_state).eval();
  for (std::size_t c = 0; c < path.size(); ++c) {
    const auto from = static_cast<Index>(c);
    const Index at = columns.of_state[c];
    if (path[c].border >= 0) {
      rows.col(at) += by_state.col(from);
      continue;
    }
    const auto& weights = basis.at[static_cast<std::size_t>(path[c].order)];
    for (Index i = 0; i < spline_order; ++i)
      rows.col(at + i) += weights[static_cast<std::size_t>(i)] * by_state.col(from);
  }
  const bool rate = use.state_row == 0, force = use.state_row == 6;
  const Index bias = columns.own + (rate ? 0 : force ? 3 : layout.field_error);
  rows.template middleCols<3>(bias).setIdentity();
  if (layout.has_matrices && (rate || force)) {
    const Vec3& truth = rate ? state.rate : state.force;
    for (Index j = 0; j < 3; ++j)  // S is stored column by column
      for (Index i = 0; i < 3; ++i) rows(i, columns.own + (rate ? 6 : 15) + 3 * j + i) = truth[j];
  }
  if (!layout.has_tilts) return;
  auto tilt = rows.template middleCols<9>(columns.own + layout.tilt_error);
  tilt = by_tilt(felt, use);
  if (layout.has_matrices && rate) tilt += errors.rate_matrix * by_tilt(felt, use);
  if (layout.has_matrices && force) tilt += errors.force_matrix * by_tilt(felt, use);
}

FeltDerivative felt_with_derivative(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x,
                                    std::size_t sensor, Index interval, std::size_t node, const InsState& segment) {
  if (!layout.has_tilts) return {segment, Mat3::Identity(), {}, {}, {}};
  const InsBending& bending = problem.sensors[sensor].bending[static_cast<std::size_t>(interval)];
  return felt_derivative(segment, x.errors[sensor].tilt, bending.force_at(node), bending.change_at(node));
}

}  // namespace

SensorColumns sensor_columns(const InsLayout& layout, const InsPaths& paths, std::size_t body, std::size_t sensor) {
  SensorColumns columns;
  const Index local = spline_order * layout.channels;
  const auto& channels = paths.channels[body];
  for (const Index channel : channels)
    for (Index i = 0; i < spline_order; ++i) columns.index.push_back(i * layout.channels + channel);
  for (const InsColumn& column : paths.columns[body]) {
    if (column.border >= 0) {
      columns.of_state.push_back(static_cast<Index>(columns.index.size()));
      columns.index.push_back(local + column.border);
    } else {
      columns.of_state.push_back(spline_order * (std::ranges::find(channels, column.channel) - channels.begin()));
    }
  }
  columns.own = static_cast<Index>(columns.index.size());
  for (Index i = 0; i < layout.errors_each; ++i) columns.index.push_back(local + layout.error[sensor] + i);
  return columns;
}

SensorSystem sensor_system(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x,
                           const SensorColumns& columns, const std::vector<InsColumn>& path, std::size_t body,
                           Index interval, const std::array<NodeMotion, block_nodes>& motion,
                           const std::array<SplineBasis, block_nodes>& bases) {
  const auto sensor = static_cast<std::size_t>(x.bodies[body].sensor);
  const auto uses = instruments(problem, layout, sensor);
  const InsErrors errors = errors_at(problem, x, sensor, interval);
  const auto k = static_cast<std::size_t>(interval);
  Index rows = 0;
  for (const InstrumentUse& use : uses) rows += 3 * use.blocks[k].rows;
  const auto width = static_cast<Index>(columns.index.size());
  SensorSystem system{MatrixXd::Zero(rows, width), VectorXd(rows)};
  MatrixXd at_nodes(3 * block_nodes, width);
  std::array<FeltDerivative, block_nodes> felt;
  for (std::size_t n = 0; n < block_nodes; ++n)
    felt[n] = felt_with_derivative(problem, layout, x, sensor, interval, n, motion[n].state[body]);
  Index row = 0;
  for (const InstrumentUse& use : uses) {
    const InsBlock& block = use.blocks[k];
    if (block.rows == 0) continue;
    const NodeMatrix factor = shifted_factor(block, layout, clock_shift(problem, layout, errors, interval));
    BlockResidual predicted;
    for (Index node = 0; node < block_nodes; ++node) {
      const auto n = static_cast<std::size_t>(node);
      predicted.row(node) = use.read(felt[n].state, errors).transpose();
      fill_rows(at_nodes.middleRows<3>(3 * node), use, layout, columns, path, motion[n].columns[body], felt[n], errors,
                bases[n]);
    }
    const BlockResidual r = residual(block, factor, predicted, use.sd);
    const double weight = std::sqrt(robust(r.squaredNorm(), 3.0 * block.rows).weight);
    const BlockResidual by_shift = block.factor.cast<double>() * (node_derivative() * predicted);
    for (Index i = 0; i < block.rows; ++i, row += 3) {
      for (Index node = 0; node < block_nodes; ++node)
        if (std::abs(factor(i, node)) > 0.0)
          system.jacobian.middleRows<3>(row) += (weight * factor(i, node) / use.sd) * at_nodes.middleRows<3>(3 * node);
      if (layout.has_clocks) {
        const Index clock = columns.own + layout.clock_error;
        const Vec3 by_offset = (weight / (use.sd * problem.grid.period)) * by_shift.row(i).transpose();
        system.jacobian.block<3, 1>(row, clock) = by_offset;
        system.jacobian.block<3, 1>(row, clock + 1) = from_middle(problem.grid, interval) * by_offset;
      }
      system.residual.segment<3>(row) = weight * r.row(i).transpose();
    }
  }
  return system;
}

}  // namespace kinfer
