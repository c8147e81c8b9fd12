// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/refinement/fits/mount_compliance.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/identify/refinement/fits/thresholds.hpp"

namespace kinfer::identify {

double estimate_mount_compliance(const InsProblem& problem, const InsFit& fit, const InsCovariance& covariance) {
  const double prior = problem.prior.tilt * problem.prior.tilt;
  double sum_of_squares = 0.0, observed_count = 0.0;
  for (const Eigen::Index first : fit.layout.error)
    for (Eigen::Index i = 0; i < 9; ++i) {
      const Eigen::Index k = first + fit.layout.tilt_error + i;
      const double variance = std::max(1.0, covariance.inflation[k]) * covariance.model(k, k);
      observed_count += std::clamp(1.0 - variance / prior, 0.0, 1.0);
    }
  for (const InsErrors& errors : fit.unknowns.errors) sum_of_squares += errors.tilt.squaredNorm();
  return observed_count > 0.0 ? std::max(min_mount_compliance, std::sqrt(sum_of_squares / observed_count))
                              : problem.prior.tilt;
}

}  // namespace kinfer::identify
