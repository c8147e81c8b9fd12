// SPDX-License-Identifier: Apache-2.0
#include "kinfer/motion/s_ramp.hpp"

#include <algorithm>
#include <cmath>

namespace kinfer::motion {

SRamp::SRamp(double acceleration, double jerk) : jerk_(jerk) {
  // Without a constant part the peak acceleration is sqrt(jerk).
  if (acceleration * acceleration >= jerk) {
    jerk_time_ = std::sqrt(1.0 / jerk);
  } else {
    jerk_time_ = acceleration / jerk;
    constant_time_ = 1.0 / acceleration - jerk_time_;
  }
}

RampState SRamp::at(double t) const {
  const double all = duration();
  if (all == 0.0) return {0.0, 1.0, 0.0, 0.0};
  // The second half mirrors the first, so that the end is met exactly.
  const bool mirrored = t > 0.5 * all;
  const double u = std::clamp(mirrored ? all - t : t, 0.0, 0.5 * all);
  RampState state;
  if (u <= jerk_time_) {
    state = {jerk_ * u * u * u / 6.0, 0.5 * jerk_ * u * u, jerk_ * u, jerk_};
  } else {
    const double peak = jerk_ * jerk_time_, v = 0.5 * peak * jerk_time_, w = u - jerk_time_;
    state = {peak * jerk_time_ * jerk_time_ / 6.0 + v * w + 0.5 * peak * w * w, v + peak * w, peak, 0.0};
  }
  // The integral over the mirrored half: (t − all/2) plus that of the first half seen from the end.
  if (mirrored) state = {0.5 * all - u + state.position, 1.0 - state.speed, state.acceleration, -state.jerk};
  state.position /= all;
  return state;
}

}  // namespace kinfer::motion
