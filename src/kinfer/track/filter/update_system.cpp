// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/filter/update_system.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/linalg/small_cholesky.hpp"
#include "kinfer/track/model/thresholds.hpp"

namespace kinfer::track {
namespace {

/// A moving base, ranges and velocities of prismatic joints, velocities of revolute ones, strays of loose ones.
Index most_soft_rows(const FilterModel& model) {
  return 3 + 2 * static_cast<Index>(model.loose.size() + model.prismatic.size()) +
         static_cast<Index>(model.revolute.size());
}

}  // namespace

Index UpdateSystem::most_rows(const FilterModel& model) {
  return model.layout.rows() + most_soft_rows(model);
}

UpdateSystem::UpdateSystem(const FilterModel& model) : layout_(model.layout) {
  const Index most = most_rows(model);
  residual_ = noise_ = whitened_ = VectorXd::Zero(most);
  h_ = MatrixXd::Zero(most, layout_.fast);
  w_ = MatrixXd::Zero(layout_.size, most);
  s_ = root_ = inverse_ = MatrixXd::Zero(most, most);
  is_measured_.assign(static_cast<std::size_t>(2 * layout_.sensors), false);
}

void UpdateSystem::begin(const ChainMeasurement& measurement) {
  rows_ = layout_.rows();
  h_.topRows(rows_) = measurement.by_fast;
}

void UpdateSystem::linearise_again(const ChainMeasurement& measurement) {
  h_.topRows(layout_.rows()) = measurement.by_fast;
}

void UpdateSystem::set_instrument(Index first, bool is_measured, const Vec3& residual, double variance) {
  is_measured_[static_cast<std::size_t>(first / 3)] = is_measured;
  // A row without derivatives, residual and correlation changes nothing.
  residual_.segment<3>(first) = is_measured ? residual : Vec3(Vec3::Zero());
  noise_.segment<3>(first).setConstant(is_measured ? variance : 1.0);
  if (!is_measured) h_.middleRows(first, 3).setZero();
}

Index UpdateSystem::append(double residual, double variance) {
  h_.row(rows_).setZero();
  residual_[rows_] = residual;
  noise_[rows_] = variance;
  return rows_++;
}

/// Calls visit(row, state, derivative) for a sensor's own biases and scale factors. Inlined, since the visits are loops
/// over rows and states.
template <class Visit>
[[gnu::always_inline]] inline void UpdateSystem::for_each_own_state(const ChainMeasurement& measurement, std::size_t s,
                                                                    const Visit& visit) const {
  const Index row = sensor_rows * static_cast<Index>(s), own = layout_.sensor_state(static_cast<Index>(s));
  for (Index k = 0; k < 3; ++k)
    for (Index j = 0; j < 4; ++j) {
      const bool is_bias = j == 0;
      if (is_measured_[2 * s])
        visit(row + k, own + (is_bias ? SensorIndex::gyroscope_bias + k : SensorIndex::gyroscope_scale + 3 * k + j - 1),
              is_bias ? 1.0 : measurement.angular_velocity[s][j - 1]);
      if (is_measured_[2 * s + 1])
        visit(row + 3 + k,
              own + (is_bias ? SensorIndex::accelerometer_bias + k : SensorIndex::accelerometer_scale + 3 * k + j - 1),
              is_bias ? 1.0 : measurement.force[s][j - 1]);
    }
}

void UpdateSystem::subtract_predicted(const ChainMeasurement& m, const MatrixXd& errors, MatrixRef from) const {
  for (std::size_t s = 0; s < m.fast_end.size(); ++s) {
    const Index row = sensor_rows * static_cast<Index>(s), fast = m.fast_end[s];
    add_product(errors.leftCols(fast), h_.block(row, 0, sensor_rows, fast), -1.0, from.middleCols(row, sensor_rows));
    for (Index half = 0; half < 2; ++half)
      if (const Index unseen = layout_.unseen(); unseen > 0 && is_measured_[2 * s + static_cast<std::size_t>(half)])
        add_product(errors.middleCols(layout_.first_unseen, unseen), m.by_geometry.block(row + 3 * half, 0, 3, unseen),
                    -1.0, from.middleCols(row + 3 * half, 3));
    for_each_own_state(m, s, [&](Index at, Index state, double factor) { from.col(at) -= factor * errors.col(state); });
  }
  for (Index row = layout_.rows(); row < rows_; ++row)
    for (Index j = 0; j < layout_.fast; ++j)
      if (h_(row, j) > 0.0 || h_(row, j) < 0.0) from.col(row) -= h_(row, j) * errors.col(j);
}

void UpdateSystem::multiply_covariance(const ChainMeasurement& m, const MatrixXd& p) {
  const Index n = layout_.size;
  w_.leftCols(rows_).setZero();
  for (std::size_t s = 0; s < m.fast_end.size(); ++s) {
    if (!is_measured_[2 * s] && !is_measured_[2 * s + 1]) continue;
    const Index row = sensor_rows * static_cast<Index>(s), fast = m.fast_end[s], geometry = m.geometry_end[s];
    auto w = w_.middleCols(row, sensor_rows);
    add_product(p.leftCols(fast), h_.block(row, 0, sensor_rows, fast), 1.0, w);
    if (geometry > 0)
      add_product(p.middleCols(layout_.first_unseen, geometry), m.by_geometry.block(row, 0, sensor_rows, geometry), 1.0,
                  w);
    for_each_own_state(m, s, [&](Index at, Index state, double factor) {
      double* to = w_.col(at).data();
      const double* from = p.col(state).data();
      for (Index i = 0; i < n; ++i) to[i] += factor * from[i];
    });
    for (Index half = 0; half < 2; ++half)
      if (!is_measured_[2 * s + static_cast<std::size_t>(half)]) w_.middleCols(row + 3 * half, 3).setZero();
  }
  for (Index row = layout_.rows(); row < rows_; ++row)
    for (Index j = 0; j < layout_.fast; ++j)
      if (h_(row, j) > 0.0 || h_(row, j) < 0.0) w_.col(row) += h_(row, j) * p.col(j);
}

void UpdateSystem::multiply_derivatives(const ChainMeasurement& m) {
  s_.topLeftCorner(rows_, rows_).setZero();
  for (std::size_t s = 0; s < m.fast_end.size(); ++s) {
    const Index row = sensor_rows * static_cast<Index>(s), fast = m.fast_end[s], geometry = m.geometry_end[s];
    for (Index j = 0; j <= std::min(row + sensor_rows, rows_) - 1; ++j) {
      auto to = s_.col(j).segment<sensor_rows>(row);
      for (Index k = 0; k < fast; ++k) to += w_(k, j) * h_.col(k).segment<sensor_rows>(row);
      for (Index k = 0; k < geometry; ++k)
        to += w_(layout_.first_unseen + k, j) * m.by_geometry.col(k).segment<sensor_rows>(row);
    }
    for_each_own_state(m, s, [&](Index at, Index state, double factor) {
      for (Index j = 0; j <= at; ++j) s_(at, j) += factor * w_(state, j);
    });
    for (Index half = 0; half < 2; ++half)
      if (!is_measured_[2 * s + static_cast<std::size_t>(half)]) s_.middleRows(row + 3 * half, 3).setZero();
  }
  for (Index row = layout_.rows(); row < rows_; ++row)
    for (Index k = 0; k < layout_.fast; ++k)
      if (h_(row, k) > 0.0 || h_(row, k) < 0.0)
        for (Index j = 0; j <= row; ++j) s_(row, j) += h_(row, k) * w_(k, j);
  for (Index i = 0; i < rows_; ++i) s_(i, i) += noise_[i];
}

void UpdateSystem::multiply(const ChainMeasurement& measurement, const MatrixXd& p) {
  multiply_covariance(measurement, p);
  multiply_derivatives(measurement);
}

void UpdateSystem::invert() {
  auto inverse = inverse_.topLeftCorner(rows_, rows_);
  inverse.setIdentity();
  for (Index j = 0; j < rows_; ++j)  // L⁻¹, column by column
    for (Index k = j; k < rows_; ++k) {
      const double x = inverse_(k, j) / root_(k, k);
      inverse_(k, j) = x;
      for (Index i = k + 1; i < rows_; ++i) inverse_(i, j) -= root_(i, k) * x;
    }
  auto whitened = whitened_.head(rows_);
  whitened.setZero();
  for (Index k = 0; k < rows_; ++k)
    for (Index i = k; i < rows_; ++i) whitened_[i] += inverse_(i, k) * residual_[k];
}

bool UpdateSystem::factorise() {
  auto root = root_.topLeftCorner(rows_, rows_);
  root = s_.topLeftCorner(rows_, rows_);
  if (!factorise_small(root)) return false;
  invert();
  return true;
}

bool UpdateSystem::limit_outliers() {
  bool has_outliers = false;
  for (std::size_t half = 0; half < is_measured_.size(); ++half) {
    if (!is_measured_[half]) continue;
    const Index row = 3 * static_cast<Index>(half);
    Mat3 block = s_.block<3, 3>(row, row);
    block.triangularView<Eigen::StrictlyUpper>() = block.transpose();
    const Vec3 v = residual_.segment<3>(row);
    const double distance = v.dot(block.inverse() * v);
    if (distance <= outlier_limit) continue;
    has_outliers = true;
    s_.block<3, 3>(row, row) += (distance / outlier_limit - 1.0) * block;
  }
  return has_outliers;
}

void UpdateSystem::divide() {
  auto y = w_.leftCols(rows_);
  solve_right(root_.topLeftCorner(rows_, rows_), y);
}

double UpdateSystem::log_root_determinant() const {
  double sum = 0.0;
  for (Index i = 0; i < rows_; ++i) sum += std::log(root_(i, i));
  return sum;
}

}  // namespace kinfer::track
