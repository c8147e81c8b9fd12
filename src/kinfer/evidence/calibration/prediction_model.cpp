// SPDX-License-Identifier: Apache-2.0
#include "kinfer/evidence/calibration/prediction_model.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace kinfer {
namespace {

/// [1] Smaller: corrections act farther from the fitted rows. Set on UR10 A (tried on B and C) and C (tried on A and
/// B): 0.25 to 4 are alike for A; for C, 0.25 is 10 % worse. Without fading, C's corrections double the error of
/// geometry.
constexpr double fade = 2.0;

constexpr Eigen::Index neighbours = 15;  ///< of which one_sidedness is taken; 6 to 30 are alike on UR10 A, B, C and FR3

/// Squared distances of the rows from q in units of `spread`.
VectorXd squared_distances(const PredictionModel& model, ConstVectorRef q) {
  const VectorXd scale = model.spread.cwiseInverse();
  return (scale.asDiagonal() * (model.rows.colwise() - VectorXd(q))).colwise().squaredNorm().transpose();
}

}  // namespace

double region_distance(const PredictionModel& model, ConstVectorRef q) {
  if (model.rows.cols() == 0) return 0.0;
  return std::sqrt(squared_distances(model, q).minCoeff()) / model.reach;
}

double correction_weight(const PredictionModel& model, ConstVectorRef q) {
  return model.beyond.size() == 0 ? 1.0 : fading_weight(model, q);
}

double fading_weight(const PredictionModel& model, ConstVectorRef q) {
  const double outside = std::max(0.0, region_distance(model, q) - 1.0);
  return 1.0 / (1.0 + fade * outside * outside);
}

double one_sidedness(const PredictionModel& model, ConstVectorRef q) {
  if (model.rows.cols() == 0) return 0.0;
  const VectorXd squares = squared_distances(model, q);
  std::vector<Eigen::Index> nearest;
  for (Eigen::Index row = 0; row < squares.size(); ++row)
    if (squares[row] > 0.0) nearest.push_back(row);
  const auto count = std::min(neighbours, static_cast<Eigen::Index>(nearest.size()) / 2);
  if (count < 2) return 0.0;
  std::ranges::partial_sort(nearest, nearest.begin() + count, {}, [&](Eigen::Index row) { return squares[row]; });
  nearest.resize(static_cast<std::size_t>(count));
  const MatrixXd near = model.spread.cwiseInverse().asDiagonal() * model.rows(Eigen::all, nearest);
  const VectorXd mean = near.rowwise().mean(), offset = q.cwiseQuotient(model.spread) - mean;
  return offset.norm() / std::sqrt((near.colwise() - mean).squaredNorm() / static_cast<double>(count));
}

double outside_share(const PredictionModel& model, ConstVectorRef q) {
  const double a = one_sidedness(model, q) / model.edge;
  return a > 0.0 ? 1.0 / (1.0 + std::pow(a, -4.0)) : 0.0;
}

MatrixXd model_error_at(const PredictionModel& model, ConstVectorRef q) {
  return model.model_error + outside_share(model, q) * model.outside_error;
}

}  // namespace kinfer
