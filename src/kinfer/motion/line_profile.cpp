// SPDX-License-Identifier: Apache-2.0
#include "kinfer/motion/line_profile.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/motion/thresholds.hpp"

namespace kinfer::motion {

MotionLimits limits_along(const VectorXd& way, const std::vector<MotionLimits>& limits) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  MotionLimits along{infinity, infinity, infinity};
  for (Eigen::Index k = 0; k < way.size(); ++k) {
    const double part = std::abs(way[k]);
    if (part == 0.0) continue;
    const MotionLimits& limit = limits[static_cast<std::size_t>(k)];
    along.velocity = std::min(along.velocity, limit.velocity / part);
    along.acceleration = std::min(along.acceleration, limit.acceleration / part);
    along.jerk = std::min(along.jerk, limit.jerk / part);
  }
  return along;
}

SRamp fastest_ramp(double change, const MotionLimits& limits) {
  const double size = std::abs(change);
  return size > 0.0 ? SRamp(limits.acceleration / size, limits.jerk / size) : SRamp();
}

LineProfile quickest_profile(double length, double first, double last, const MotionLimits& limits) {
  const auto ramp_time = [&](double change) { return fastest_ramp(change, limits).duration(); };
  const auto ramps_length = [&](double peak) {
    return 0.5 * ((first + peak) * ramp_time(peak - first) + (peak + last) * ramp_time(peak - last));
  };
  double low = std::max(first, last), high = limits.velocity;
  double missing = length - ramps_length(low), excess = ramps_length(high) - length;
  if (!(missing >= 0.0)) return {};
  if (excess <= 0.0) low = high, missing = -excess;
  // Secants by turns with bisection. What is missing at the lower peak is cruised: the line is covered exactly.
  for (int i = 0; excess > 0.0 && missing > 1e-15 * length && i < thresholds::profile_steps; ++i) {
    const double middle = 0.5 * (low + high);
    if (!(low < middle && middle < high)) break;
    const double peak =
        i % 3 == 2 ? middle : std::clamp(low + (high - low) * (missing / (missing + excess)), low, high);
    const double more = length - ramps_length(peak);
    if (more >= 0.0)
      low = peak, missing = more;
    else
      high = peak, excess = -more;
  }
  const double cruise = low > 0.0 ? missing / low : 0.0;
  return {low, cruise, ramp_time(low - first) + cruise + ramp_time(low - last)};
}

}  // namespace kinfer::motion
