#include "kinfer/estimate/identifiability.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/linalg/decompositions.hpp"

namespace kinfer {
namespace {

/// Rows span the same space as those of `basis` (k x n), each with a 1 where the others have 0: the sparsest simple
/// basis.
MatrixXd reduced_rows(MatrixXd basis) {
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

std::string list_of(const std::vector<std::string>& names) {
  std::string text = names.front();
  for (std::size_t i = 1; i < names.size(); ++i) text += (i + 1 == names.size() ? " and " : ", ") + names[i];
  return text;
}

/// Names of the parameters that take part in a direction: those whose own effect on the data is felt.
std::string words_for(ConstVectorRef direction, ConstMatrixRef scaled, const std::vector<const Parameter*>& free) {
  const VectorXd effect = scaled.colwise().norm().transpose().cwiseProduct(direction.cwiseAbs());
  constexpr double felt = 0.05;  // of the largest effect: below, the name would confuse more than it says
  const double largest = effect.maxCoeff();
  Eigen::Index leading;
  direction.cwiseAbs().maxCoeff(&leading);
  if (largest < 1.0) return free[leading]->name + " has no effect that these measurements could show";
  std::vector<std::string> names;
  for (Eigen::Index k = 0; k < effect.size(); ++k)
    if (effect[k] > felt * largest) names.push_back(free[k]->name);
  if (names.size() == 1) return names.front() + " is not known better than its tolerance from these poses";
  return list_of(names) + " cannot be told apart from these poses";
}

}  // namespace

Identifiability identifiability(ConstMatrixRef jacobian, const ParameterSet& set) {
  const std::vector<const Parameter*> free = set.free();
  Identifiability found;
  if (free.empty()) return found;
  MatrixXd scaled = jacobian;
  for (std::size_t k = 0; k < free.size(); ++k)
    scaled.col(static_cast<Eigen::Index>(k)) *= std::isfinite(free[k]->prior_sd) ? free[k]->prior_sd : free[k]->scale;
  const RightSvd decomposition = right_svd(scaled);
  found.singular_values = decomposition.s;
  found.rank = static_cast<int>((decomposition.s.array() > 1.0).count());
  const Eigen::Index unknown = decomposition.s.size() - found.rank;
  if (unknown == 0) return found;
  const MatrixXd directions = reduced_rows(decomposition.v.rightCols(unknown).transpose());
  for (Eigen::Index i = 0; i < unknown; ++i)
    found.confounded.push_back(words_for(directions.row(i).transpose(), scaled, free));
  std::sort(found.confounded.begin(), found.confounded.end());
  return found;
}

}  // namespace kinfer
