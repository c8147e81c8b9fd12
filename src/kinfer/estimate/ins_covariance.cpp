#include "kinfer/estimate/ins_covariance.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/linalg/decompositions.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;

/// Outer products of the scores summed over blocks of `intervals`.
MatrixXd spread_of_scores(ConstMatrixRef scores, Index intervals) {
  MatrixXd spread = MatrixXd::Zero(scores.cols(), scores.cols());
  for (Index first = 0; first < scores.rows(); first += intervals) {
    const VectorXd sum = scores.middleRows(first, std::min(intervals, scores.rows() - first)).colwise().sum();
    spread += sum * sum.transpose();
  }
  return spread;
}

}  // namespace

std::optional<InsCovariance> covariance_of(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x,
                                           int threads, double block) {
  const BorderedBand band = eliminated(problem, layout, x, {}, threads);
  if (!band.positive()) return std::nullopt;
  const auto inverse = inverse_positive(band.schur());
  if (!inverse) return std::nullopt;
  InsCovariance result{*inverse, VectorXd::Ones(layout.border)};
  const MatrixXd scores = interval_scores(problem, layout, x, band.following(), threads);
  const auto intervals = std::max<Index>(1, static_cast<Index>(std::round(block / problem.grid.period)));
  const MatrixXd middle = spread_of_scores(scores, intervals) + border_prior(problem, layout, x).matrix;
  const MatrixXd half = middle * result.model;
  for (Index k = 0; k < layout.border; ++k)
    result.inflation[k] = result.model.col(k).dot(half.col(k)) / result.model(k, k);
  return result;
}

}  // namespace kinfer
