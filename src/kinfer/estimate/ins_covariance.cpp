#include "kinfer/estimate/ins_covariance.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/estimate/ins_system.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;

}  // namespace

std::optional<InsCovariance> covariance_of(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x,
                                           int threads, double block) {
  const InsSystem system(problem, layout, x, {}, threads);
  if (!system.positive()) return std::nullopt;
  const auto inverse = inverse_positive(system.schur());
  if (!inverse) return std::nullopt;
  InsCovariance result{*inverse, VectorXd::Ones(layout.border)};
  const auto intervals = std::max<Index>(1, static_cast<Index>(std::round(block / problem.grid.period)));
  const MatrixXd scores = system.block_scores(intervals);
  const MatrixXd middle =
      scores.transpose() * scores + border_prior(problem, layout, x).matrix + system.wander_information();
  const MatrixXd half = middle * result.model;
  for (Index k = 0; k < layout.border; ++k)
    result.inflation[k] = result.model.col(k).dot(half.col(k)) / result.model(k, k);
  return result;
}

}  // namespace kinfer
