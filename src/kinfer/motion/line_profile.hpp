// SPDX-License-Identifier: Apache-2.0
// The quickest motion along a line between two speeds: a ramp to a peak speed, a cruise, and a ramp to the last speed.
//
// The double S of Biagiotti and Melchiorri 2008, section 3.4, with speeds at its ends and accelerations of 0 there. The
// ramps are symmetric, so each covers its duration times the mean of its speeds, and the length grows with the peak.
#pragma once

#include <limits>
#include <vector>

#include "kinfer/linalg/types.hpp"
#include "kinfer/motion/s_ramp.hpp"

namespace kinfer::motion {

/// What the joints allow along `way`, not 0: of the part of it that is covered [1/s], [1/s²], [1/s³].
MotionLimits limits_along(const VectorXd& way, const std::vector<MotionLimits>& limits);

/// The fastest ramp by `change` of speed; of no duration where that is 0.
SRamp fastest_ramp(double change, const MotionLimits& limits);

struct LineProfile {
  double peak = 0.0;                                          ///< speed between the two ramps
  double cruise = 0.0;                                        ///< [s] for which it is kept
  double duration = std::numeric_limits<double>::infinity();  ///< [s]
};

/// Over `length` with the speeds `first` and `last` at its ends, within the limit of velocity. The duration is infinite
/// where the line is too short for the change of speed.
LineProfile quickest_profile(double length, double first, double last, const MotionLimits& limits);

}  // namespace kinfer::motion
