// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/loops/loop_odds.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "kinfer/identify/loops/thresholds.hpp"

namespace kinfer::identify {
namespace {

/// ln of the likelihood ratio of a gap of two components, of which `gap` and `other` are rms norms and `sd` is that of
/// one component.
double log_ratio(double gap, double sd, double other, double positions) {
  const double range = other / std::numbers::sqrt2;
  if (range <= sd) return 0.0;  // indistinguishable
  return std::max(0.0, 2.0 * positions - 4.0) * std::log(range / sd) -
         0.5 * positions * gap * gap * (1.0 / (sd * sd) - 1.0 / (range * range));
}

/// The same for a standard deviation that is known up to two orders of magnitude, all of them alike: the mean of the
/// likelihood ratio. `beside`: of another cause, which is known.
double mean_log_ratio(double gap, double largest_sd, double beside, double other, double positions) {
  constexpr int scales = 9;
  constexpr double decades = 2.0;
  std::array<double, scales> ratios{};
  for (int k = 0; k < scales; ++k) {
    const double sd = largest_sd * std::pow(10.0, -decades * k / (scales - 1));
    ratios[static_cast<std::size_t>(k)] = log_ratio(gap, std::hypot(sd, beside), other, positions);
  }
  const double largest = *std::ranges::max_element(ratios);
  double sum = 0.0;
  for (const double ratio : ratios) sum += std::exp(ratio - largest);
  return largest + std::log(sum / scales);
}

}  // namespace

double log_odds(const LoopEvidence& evidence) {
  const ClosingJoint &closing = evidence.closing, &mirrored = evidence.mirrored;
  // Orientation errors of the estimated motion show as misalignment of axes that are parallel, and shift the far end.
  const double tilt = std::min(closing.misalignment, max_loop_axis_sd);
  return mean_log_ratio(closing.gap, max_loop_point_sd, evidence.lever * tilt, mirrored.gap, evidence.positions) +
         mean_log_ratio(closing.misalignment, max_loop_axis_sd, 0.0, mirrored.misalignment, evidence.positions) +
         loop_log_prior_odds;
}

}  // namespace kinfer::identify
