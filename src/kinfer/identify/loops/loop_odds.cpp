// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/loops/loop_odds.hpp"

#include <algorithm>
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

}  // namespace

double log_odds(const LoopEvidence& evidence) {
  const ClosingJoint &closing = evidence.closing, &mirrored = evidence.mirrored;
  // Orientation errors of the estimated motion show as misalignment of axes that are parallel, and shift the far end.
  const double tilt = std::min(closing.misalignment, loop_axis_sd);
  const double sd = std::hypot(loop_point_sd, evidence.lever * tilt);
  return log_ratio(closing.gap, sd, mirrored.gap, evidence.positions) +
         log_ratio(closing.misalignment, loop_axis_sd, mirrored.misalignment, evidence.positions) + loop_log_prior_odds;
}

}  // namespace kinfer::identify
