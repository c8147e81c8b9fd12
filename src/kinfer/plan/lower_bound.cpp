// SPDX-License-Identifier: Apache-2.0
#include "kinfer/plan/lower_bound.hpp"

#include <algorithm>

#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/linalg/products.hpp"
#include "kinfer/plan/thresholds.hpp"

namespace kinfer::plan {

double mean_square_lower_bound(const DesignProblem& problem, int count) {
  const Eigen::Index n = problem.rows.cols(), candidates = problem.candidates();
  const Eigen::Index place_count = problem.targets.rows() / 3;
  const MatrixXd places = gram(problem.targets) / static_cast<double>(place_count);
  MatrixXd fixed = MatrixXd::Identity(n, n);
  if (problem.prior_information.size() > 0) fixed += problem.prior_information;
  VectorXd weight = VectorXd::Constant(candidates, 1.0 / static_cast<double>(candidates));
  double bound = 0.0;
  for (int round = 0; round < thresholds::bound_rounds; ++round) {
    const VectorXd root = (static_cast<double>(count) * weight).cwiseSqrt();
    const MatrixXd weighted = root.transpose().replicate(problem.block, 1).reshaped().asDiagonal() * problem.rows;
    const auto covariance = invert_spd(fixed + gram(weighted));
    if (!covariance) break;
    const MatrixXd felt = propagated_covariance(*covariance, places);
    const VectorXd of_rows = product(problem.rows, felt).cwiseProduct(problem.rows).rowwise().sum();
    const VectorXd gain = of_rows.reshaped(problem.block, candidates).colwise().sum().transpose();
    const double now = places.cwiseProduct(*covariance).sum();
    bound = std::max(bound, now - count * (gain.maxCoeff() - weight.dot(gain)));
    if (now - bound <= thresholds::bound_gap * now) break;
    weight = weight.cwiseProduct(gain.cwiseMax(0.0).cwiseSqrt());
    weight /= weight.sum();
  }
  return bound;
}

}  // namespace kinfer::plan
