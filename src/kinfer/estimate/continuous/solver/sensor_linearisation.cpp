// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/solver/sensor_linearisation.hpp"

#include <cmath>

#include "kinfer/estimate/continuous/model/bias_process.hpp"
#include "kinfer/linalg/block_products.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;

/// Index of an instrument's part.
std::size_t part_of(const InstrumentMeasurements& instrument) {
  return instrument.state_row == force_row ? 1 : 0;
}

/// Appends columns of further global parameters; returns the first column.
Index append(SensorRows& part, Index first, Index count) {
  const Index column = number_of(part.band) + number_of(part.border);
  for (Index i = 0; i < count; ++i) part.border.push_back(first + i);
  return column;
}

Index append(SensorRows& part, const std::vector<Index>& unknowns) {
  const Index column = number_of(part.band) + number_of(part.border);
  part.border.insert(part.border.end(), unknowns.begin(), unknowns.end());
  return column;
}

/// Satisfied bounds, whose residual is 0, do not depend on the unknowns. The part's rows are those of the block.
void drop_satisfied_rows(SensorRows& part, const BlockResidual& r, const InstrumentMeasurements& instrument,
                         Index interval) {
  const auto at = static_cast<std::size_t>(interval);
  for (Index i = 0; i < instrument.blocks[at].rows; ++i)
    for (Index axis = 0; axis < 3; ++axis)
      if (is_satisfied((*instrument.sides)[at][static_cast<std::size_t>(i)][static_cast<std::size_t>(axis)],
                       r(i, axis)))
        part.jacobian.col(part.used + 3 * i + axis).setZero();
}

/// Derivatives of one instrument's measurement with respect to the tilt compliance.
const Eigen::Matrix<double, 3, 9>& by_tilt(const MountDerivative& on_mount, Index state_row) {
  return state_row == rate_row ? on_mount.velocity_by_tilt : on_mount.force_by_tilt;
}

}  // namespace

SensorLinearisation::SensorLinearisation(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x,
                                         const IntervalMotion& motion, std::size_t body, LinearisationScope scope)
    : problem_(problem),
      layout_(layout),
      x_(x),
      motion_(motion),
      body_(body),
      sensor_(static_cast<std::size_t>(x.bodies[body].sensor)),
      scope_(scope),
      instruments_(instruments(problem, sensor_)) {
  const InsPath& path = motion.path(body);
  for (SensorRows& part : parts_)
    for (Index i = 0; i < spline_order; ++i)
      for (const Index spline_dimension : path.spline_dimensions)
        part.band.push_back(i * layout.spline_dimensions + spline_dimension);
  if (scope == LinearisationScope::everything) append_global_columns(path);
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    SensorRows& part = parts_[p];
    const auto count = std::ranges::count(instruments_, p, part_of);
    part.jacobian.resize(number_of(part.band) + number_of(part.border), 3 * block_nodes * count);
    part.residual.resize(part.jacobian.cols());
    part.weight.resize(part.jacobian.cols());
  }
}

/// Measurements and bounds of an instrument share its errors.
void SensorLinearisation::append_global_columns(const InsPath& path) {
  const Index errors = layout_.error[sensor_];
  for (const Index p : {0, 1}) {
    SensorRows& part = parts_[static_cast<std::size_t>(p)];
    part.rotational = append(part, path.rotational);
    if (p == 1) part.translational = append(part, path.translational);
    part.bias = append(part, errors + 3 * p, 3);
    if (layout_.has_matrices) part.matrix = append(part, errors + 6 + 9 * p, 9);
    if (layout_.has_tilts) part.tilt = append(part, errors + layout_.tilt_error, 9);
    if (layout_.has_clocks) part.clock = append(part, errors + layout_.clock_error, 2);
  }
}

void SensorLinearisation::move_to(Index interval) {
  errors_ = errors_at(problem_, x_, sensor_, interval);
  update_sensor_states(interval);
  for (SensorRows& part : parts_) part.used = 0;
  for (const InstrumentMeasurements& instrument : instruments_) add_rows(instrument, interval);
}

void SensorLinearisation::update_sensor_states(Index interval) {
  const auto& segment = motion_.body(body_).state;
  for (std::size_t n = 0; n < block_nodes; ++n) {
    on_mount_[n].state = segment[n];
    if (!layout_.has_tilts) continue;
    const InsMountLoad& mount_load = problem_.sensors[sensor_].mount_load[static_cast<std::size_t>(interval)];
    on_mount_[n] = state_on_mount_derivative(segment[n], errors_.tilt, mount_load.force_at(n), mount_load.change_at(n));
  }
}

void SensorLinearisation::add_rows(const InstrumentMeasurements& instrument, Index interval) {
  const InsBlock& block = instrument.blocks[static_cast<std::size_t>(interval)];
  if (block.rows == 0) return;
  SensorRows& part = parts_[part_of(instrument)];
  BlockResidual predicted;
  for (std::size_t n = 0; n < block_nodes; ++n)
    predicted.row(static_cast<Index>(n)) = instrument.read(on_mount_[n].state, errors_).transpose();
  const NodeMatrix factor = shifted_factor(block, layout_, clock_shift(problem_, layout_, errors_, interval));
  BlockResidual r = residual(block, factor, predicted, instrument.sd);
  drop_satisfied(r, instrument, interval);
  const double weight = std::sqrt(robust(r.squaredNorm(), 3.0 * block.rows).weight), scale = weight / instrument.sd;
  WeightedBlock weighed{instrument, part, scale * factor, {}, part.used, block.rows};
  weighed.by_state.fill(scaled(instrument));
  if (layout_.has_tilts)
    for (std::size_t n = 0; n < block_nodes; ++n) weighed.by_state[n] *= on_mount_[n].turn;
  put_spline_columns(weighed);
  if (scope_ == LinearisationScope::everything) {
    part.jacobian.block(number_of(part.band), part.used, number_of(part.border), 3 * block.rows).setZero();
    const BodyMotion& body = motion_.body(body_);
    put_global_columns(weighed, body.rotational.middleCols(instrument.state_row * block_nodes, 3 * block_nodes),
                       part.rotational);
    if (instrument.state_row == force_row) put_global_columns(weighed, body.translational, part.translational);
    put_errors(weighed);
    if (layout_.has_clocks)
      put_clock(weighed, scale * block.factor.cast<double>() * (node_derivative() * predicted), interval);
  }
  if (instrument.is_bound()) drop_satisfied_rows(part, r, instrument, interval);
  for (Index i = 0; i < block.rows; ++i) part.residual.segment<3>(part.used + 3 * i) = weight * r.row(i).transpose();
  part.weight.segment(part.used, 3 * block.rows).setConstant(weight);
  part.used += 3 * block.rows;
}

/// Scale matrix of the instrument: I + S.
Mat3 SensorLinearisation::scaled(const InstrumentMeasurements& instrument) const {
  return Mat3::Identity() + (instrument.state_row == rate_row ? errors_.gyroscope_scale : errors_.accelerometer_scale);
}

/// Chain rule for each coefficient of each spline dimension: block row by nodes, nodes by the dimension's time
/// derivatives, these by the coefficient.
void SensorLinearisation::put_spline_columns(const WeightedBlock& w) {
  constexpr Index derivatives = block_nodes * derivative_orders;
  SensorRows& part = w.part;
  const MatrixXd& by_spline = motion_.body(body_).by_spline;
  const Index spline_dimensions = number_of(part.band) / spline_order, first = w.instrument.state_row * block_nodes;
  std::array<Eigen::Matrix<double, spline_order, derivatives>, block_nodes> coefficients;  // for each row of the block
  for (Index i = 0; i < w.rows; ++i)
    for (Index k = 0; k < derivatives; ++k) {
      const auto node = static_cast<std::size_t>(k / derivative_orders),
                 order = static_cast<std::size_t>(k % derivative_orders);
      const Eigen::Map<const Eigen::Matrix<double, spline_order, 1>> basis(motion_.bases()[node].at[order].data());
      coefficients[static_cast<std::size_t>(i)].col(k) = w.weight(i, static_cast<Index>(node)) * basis;
    }
  for (Index c = 0; c < spline_dimensions; ++c) {
    Eigen::Matrix<double, derivatives, 3> shown;  // by the dimension's time derivatives at the nodes
    for (Index k = 0; k < derivatives; ++k) {
      const Index node = k / derivative_orders, row = c * derivative_orders + k % derivative_orders;
      const Vec3 truth(by_spline(row, first + node), by_spline(row, first + block_nodes + node),
                       by_spline(row, first + 2 * block_nodes + node));
      shown.row(k) = (w.by_state[static_cast<std::size_t>(node)] * truth).transpose();
    }
    for (Index i = 0; i < w.rows; ++i) {
      const Eigen::Matrix<double, spline_order, 3> by_coefficients =
          coefficients[static_cast<std::size_t>(i)].lazyProduct(shown);
      for (Index axis = 0; axis < 3; ++axis) {
        double* to = part.jacobian.col(w.first + 3 * i + axis).data() + c;
        for (Index k = 0; k < spline_order; ++k) to[k * spline_dimensions] = by_coefficients(k, axis);
      }
    }
  }
}

/// `by_unknowns`: three components of the segment's state, each at all nodes.
void SensorLinearisation::put_global_columns(const WeightedBlock& w, const Eigen::Ref<const MatrixXd>& by_unknowns,
                                             Index column) {
  MatrixXd& jacobian = w.part.jacobian;
  Eigen::Matrix<double, block_nodes, 3 * block_nodes> weight;
  for (Index axis = 0; axis < 3; ++axis) {
    for (Index component = 0; component < 3; ++component)
      for (Index node = 0; node < block_nodes; ++node)
        weight.col(component * block_nodes + node) =
            w.by_state[static_cast<std::size_t>(node)](axis, component) * w.weight.col(node);
    Eigen::Map<MatrixXd, 0, Eigen::OuterStride<>> every_third(jacobian.col(w.first + axis).data() + column,
                                                              by_unknowns.rows(), w.rows,
                                                              Eigen::OuterStride<>(3 * jacobian.rows()));
    add_product(by_unknowns, weight.topRows(w.rows), 1.0, every_third);
  }
}

void SensorLinearisation::put_errors(const WeightedBlock& w) {
  MatrixXd& jacobian = w.part.jacobian;
  const Index state_row = w.instrument.state_row;
  const Mat3 scale = scaled(w.instrument);
  for (Index i = 0; i < w.rows; ++i)
    for (Index axis = 0; axis < 3; ++axis) jacobian(w.part.bias + axis, w.first + 3 * i + axis) = w.weight.row(i).sum();
  for (std::size_t n = 0; n < block_nodes; ++n) {
    const Vec3& truth = state_row == rate_row ? on_mount_[n].state.angular_velocity : on_mount_[n].state.force;
    const Eigen::Matrix<double, 3, 9> tilting =
        layout_.has_tilts ? Eigen::Matrix<double, 3, 9>(scale * by_tilt(on_mount_[n], state_row))
                          : Eigen::Matrix<double, 3, 9>(Eigen::Matrix<double, 3, 9>::Zero());
    for (Index i = 0; i < w.rows; ++i) {
      const double weight = w.weight(i, static_cast<Index>(n));
      for (Index axis = 0; axis < 3; ++axis) {
        auto row = jacobian.col(w.first + 3 * i + axis);
        if (layout_.has_matrices)  // S is stored column by column
          for (Index j = 0; j < 3; ++j) row[w.part.matrix + 3 * j + axis] += weight * truth[j];
        if (layout_.has_tilts) row.segment<9>(w.part.tilt) += weight * tilting.row(axis).transpose();
      }
    }
  }
}

/// `by_shift`: derivative of the block's rows with respect to the time shift in intervals.
void SensorLinearisation::put_clock(const WeightedBlock& w, const BlockResidual& by_shift, Index interval) {
  SensorRows& part = w.part;
  for (Index i = 0; i < w.rows; ++i)
    for (Index axis = 0; axis < 3; ++axis) {
      auto row = part.jacobian.col(w.first + 3 * i + axis);
      row[part.clock] = by_shift(i, axis) / problem_.grid.period;
      row[part.clock + 1] = from_middle(problem_.grid, interval) * row[part.clock];
    }
}

}  // namespace kinfer
