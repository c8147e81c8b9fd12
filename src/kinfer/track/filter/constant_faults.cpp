// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/filter/constant_faults.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/geometry/rotation.hpp"
#include "kinfer/track/model/thresholds.hpp"

namespace kinfer::track {

TurnDerivative scales_by_turn() {
  TurnDerivative by_turn = TurnDerivative::Zero();
  for (Index axis = 0; axis < 3; ++axis) {
    const Mat3 turn = skew(Vec3::Unit(axis));
    for (Index half = 0; half < 2; ++half)
      for (Index i = 0; i < 3; ++i)
        for (Index j = 0; j < 3; ++j) by_turn(9 * half + 3 * i + j, axis) = turn(i, j);
  }
  return by_turn;
}

ConstantFaults::ConstantFaults(const FilterModel& model)
    : sensors_(model.layout.sensors), stretch_length_(fault_stretch) {
  const Index unknowns = 3 * sensors_ + 2;
  s_ = MatrixXd::Zero(unknowns, model.layout.first_geometry);
  g_ = MatrixXd::Zero(unknowns, UpdateSystem::most_rows(model));
  information_ = block_information_ = MatrixXd::Zero(unknowns, unknowns);
  block_score_ = VectorXd::Zero(unknowns);
  force_direction_.assign(static_cast<std::size_t>(sensors_), Vec3::Zero());
  sums_.resize(static_cast<std::size_t>(sensors_) + 2);
  by_stretch_.assign(most_stretches, sums_);
}

void ConstantFaults::predict(const FilterModel& model, const ChainState& before, double dt, ShownMeans means) {
  predict_error(model, before, dt, s_, means);
}

/// Gᵀ = (Z − H s)ᵀ.
void ConstantFaults::form_signatures(const UpdateSystem& system, const ChainMeasurement& predicted,
                                     const VectorXd& change) {
  auto g = g_.leftCols(system.rows());
  g.setZero();
  for (std::size_t s = 0; s < static_cast<std::size_t>(sensors_); ++s) {
    const Index own = 3 * static_cast<Index>(s), row = sensor_rows * static_cast<Index>(s);
    if (system.is_measured()[2 * s]) {
      g.block<3, 3>(own, row) = skew(predicted.angular_velocity[s]);
      g.block<1, 3>(3 * sensors_, row) = -change.segment<3>(row).transpose();
    }
    if (system.is_measured()[2 * s + 1]) {
      g.block<3, 3>(own, row + 3) = skew(predicted.force[s]);
      g.block<1, 3>(3 * sensors_ + 1, row + 3) = predicted.force[s].transpose();
    }
  }
  system.subtract_predicted(predicted, s_, g);
}

void ConstantFaults::sum_up(double length) {
  information_ += block_information_;
  observed_ += length;
  if (in_stretch_ <= 0.0) {
    if (stretches_ == most_stretches) {
      for (std::size_t k = 0; k < most_stretches / 2; ++k)
        for (std::size_t f = 0; f < sums_.size(); ++f) {
          FaultScore& merged = by_stretch_[k][f];
          const FaultScore first = by_stretch_[2 * k][f], second = by_stretch_[2 * k + 1][f];
          merged = {first.score + second.score, first.information + second.information};
        }
      stretches_ = most_stretches / 2;
      stretch_length_ *= 2.0;
    }
    for (FaultScore& score : by_stretch_[stretches_]) score = {};
    ++stretches_;
  }
  std::vector<FaultScore>& stretch = by_stretch_[stretches_ - 1];
  for (std::size_t f = 0; f < sums_.size(); ++f) {
    const Index n = unknowns(f, size()), at = f < static_cast<std::size_t>(sensors_)
                                                  ? 3 * static_cast<Index>(f)
                                                  : 2 * sensors_ + static_cast<Index>(f);
    for (FaultScore* sum : {&sums_[f], &stretch[f]}) {
      sum->score.head(n) += block_score_.segment(at, n);
      sum->information.topLeftCorner(n, n) += block_information_.block(at, at, n, n);
    }
  }
  in_stretch_ += length;
  if (in_stretch_ >= stretch_length_ - 1e-9) in_stretch_ = 0.0;
}

void ConstantFaults::update(const UpdateSystem& system, const ChainMeasurement& predicted, const VectorXd& change,
                            double length, Index estimated) {
  form_signatures(system, predicted, change);
  auto g = g_.leftCols(system.rows());
  system.whiten(g);
  block_score_.noalias() = g * system.whitened();
  block_information_.noalias() = g * g.transpose();
  sum_up(length);
  for (std::size_t s = 0; s < force_direction_.size(); ++s)
    force_direction_[s] += length * predicted.force[s].normalized();
  add_product(g, system.gain().topRows(estimated), 1.0, s_.leftCols(estimated));
}

void ConstantFaults::update(const std::array<Index, 6>& at, const std::array<double, 6>& factor, int terms,
                            const VectorXd& w, double variance, Index estimated) {
  VectorXd& predicted = block_score_;
  predicted.setZero();
  for (std::size_t i = 0; i < static_cast<std::size_t>(terms); ++i) predicted += factor[i] * s_.col(at[i]);
  for (Index j = 0; j < estimated; ++j) s_.col(j) -= (w[j] / variance) * predicted;
}

double ConstantFaults::force_scatter(std::size_t sensor) const {
  return std::sqrt(std::max(0.0, 1.0 - (force_direction_[sensor] / observed_).squaredNorm()));
}

void ConstantFaults::believe_turn(std::size_t sensor, const MatrixXd& off, const Mat3& covariance, double excess) {
  // The belief, covariance times score / excess, depends on all faults by the scores that they share with the turn.
  const MatrixXd by_fault = information_.middleCols<3>(3 * static_cast<Index>(sensor)) * (covariance / excess);
  s_ -= by_fault * off.transpose();
  information_.setZero();
  for (FaultScore& sum : sums_) sum = {};
  for (Vec3& direction : force_direction_) direction.setZero();
  stretches_ = 0;
  in_stretch_ = observed_ = 0.0;
}

}  // namespace kinfer::track
