// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/terms/decision.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "kinfer/base/expect.hpp"
#include "kinfer/calibrate/terms/thresholds.hpp"
#include "kinfer/geometry/statistics.hpp"

namespace kinfer::calibrate {

ErrorChange compare_errors(std::span<const double> before, std::span<const double> after) {
  KINFER_EXPECT(before.size() == after.size(), "{} and {} errors", before.size(), after.size());
  ErrorChange change;
  if (before.size() < 2) return change;
  std::vector<double> reduction;
  for (std::size_t i = 0; i < before.size(); ++i) reduction.push_back(before[i] - after[i]);
  change.mean_before = mean(before), change.mean_after = mean(after);
  change.worst_before = *std::ranges::max_element(before), change.worst_after = *std::ranges::max_element(after);
  const double standard_error = standard_deviation(reduction) / std::sqrt(static_cast<double>(reduction.size()));
  change.t = mean(reduction) / (standard_error + 1e-300);
  return change;
}

Decision decide_by_interpolation(const ErrorChange& interpolation, double geometry_worst) {
  if (interpolation.mean_after >= (1.0 - thresholds::min_reduction) * interpolation.mean_before)
    return Decision::no_improvement;
  if (interpolation.t < thresholds::min_significance) return Decision::not_significant;
  const double worst_allowed = thresholds::worst_error_ratio * std::max(interpolation.worst_before, geometry_worst);
  return interpolation.worst_after > worst_allowed ? Decision::worst_error_rises : Decision::accepted;
}

Decision decide(const ErrorChange& interpolation, const ErrorChange& extrapolation, double geometry_worst) {
  const Decision inside = decide_by_interpolation(interpolation, geometry_worst);
  if (inside != Decision::accepted) return inside;
  return extrapolation.mean_after > thresholds::extrapolation_ratio * extrapolation.mean_before
             ? Decision::extrapolation_worse
             : Decision::accepted;
}

}  // namespace kinfer::calibrate
