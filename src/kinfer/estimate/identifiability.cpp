// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/identifiability.hpp"

#include <cmath>

#include "kinfer/linalg/decompositions.hpp"

namespace kinfer {
namespace {

/// Reduced row echelon form with full pivoting of `basis` (k x n): same row space, each row with a 1 where the others
/// have 0, so that few parameters appear in each row.
MatrixXd reduced_row_echelon(MatrixXd basis) {
  for (Eigen::Index row = 0; row < basis.rows(); ++row) {
    Eigen::Index pivot_row, pivot_column;
    basis.bottomRows(basis.rows() - row).cwiseAbs().maxCoeff(&pivot_row, &pivot_column);
    basis.row(row).swap(basis.row(row + pivot_row));
    basis.row(row) /= basis(row, pivot_column);
    for (Eigen::Index other = 0; other < basis.rows(); ++other)
      if (other != row) basis.row(other) -= basis(other, pivot_column) * basis.row(row);
  }
  return basis;
}

/// Names the parameters of an unobservable direction: those whose own effect on the data is significant.
UndeterminedGroup describe_direction(ConstVectorRef direction, ConstMatrixRef scaled,
                                     const std::vector<const Parameter*>& free) {
  const VectorXd effect = scaled.colwise().norm().transpose().cwiseProduct(direction.cwiseAbs());
  constexpr double significant = 0.05;  // of the largest effect: smaller contributions are not named
  const double largest = effect.maxCoeff();
  Eigen::Index leading;
  direction.cwiseAbs().maxCoeff(&leading);
  if (largest < 1.0) return {Undetermined::no_effect, {free[leading]->name}};
  std::vector<std::string> names;
  for (Eigen::Index k = 0; k < effect.size(); ++k)
    if (effect[k] > significant * largest) names.push_back(free[k]->name);
  return {names.size() == 1 ? Undetermined::weaker_than_tolerance : Undetermined::confounded, names};
}

}  // namespace

Identifiability identifiability(ConstMatrixRef jacobian, const ParameterSet& set) {
  const std::vector<const Parameter*> free = set.free();
  Identifiability result;
  if (free.empty()) return result;
  MatrixXd scaled = jacobian;
  for (std::size_t k = 0; k < free.size(); ++k)
    scaled.col(static_cast<Eigen::Index>(k)) *= std::isfinite(free[k]->prior_sd) ? free[k]->prior_sd : free[k]->scale;
  const RightSvd decomposition = right_svd(scaled);
  result.singular_values = decomposition.s;
  result.rank = static_cast<int>((decomposition.s.array() > 1.0).count());
  const Eigen::Index unknown = decomposition.s.size() - result.rank;
  if (unknown == 0) return result;
  const MatrixXd directions = reduced_row_echelon(decomposition.v.rightCols(unknown).transpose());
  for (Eigen::Index i = 0; i < unknown; ++i)
    result.undetermined.push_back(describe_direction(directions.row(i).transpose(), scaled, free));
  return result;
}

}  // namespace kinfer
