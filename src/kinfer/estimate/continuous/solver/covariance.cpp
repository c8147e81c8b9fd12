// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/solver/covariance.hpp"

#include "kinfer/estimate/continuous/solver/normal_equations.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/linalg/products.hpp"

namespace kinfer {
std::optional<InsCovariance> model_covariance(const InsSystem& system) {
  if (!system.is_positive_definite()) return std::nullopt;
  const auto inverse = invert_spd(system.schur());
  if (!inverse) return std::nullopt;
  return InsCovariance{*inverse, VectorXd::Ones(inverse->rows())};
}

std::optional<InsCovariance> covariance_of(const InsSystem& system, double block) {
  auto result = model_covariance(system);
  if (!result) return std::nullopt;
  const auto [blocks, priors] = system.scores(block);
  const MatrixXd middle = gram(blocks) + priors;
  const MatrixXd half = product(middle, result->model);
  for (Eigen::Index k = 0; k < half.cols(); ++k)
    result->inflation[k] = result->model.col(k).dot(half.col(k)) / result->model(k, k);
  return result;
}

std::optional<InsCovariance> covariance_of(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x,
                                           int threads, double block) {
  return covariance_of(InsSystem(problem, layout, x, {}, threads), block);
}

}  // namespace kinfer
