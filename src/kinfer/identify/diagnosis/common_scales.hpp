// SPDX-License-Identifier: Apache-2.0
// Factors that all instruments of a kind share, which no comparison of sensors with each other shows.
// Accelerometers: at rest they read gravity, which is known for the Earth. All lengths have the factor of the forces.
// Gyroscopes, or the clock: what they turn must be what gravity turns in the sensor.
#pragma once

#include <span>

#include "kinfer/identify/diagnosis/mended_log.hpp"

namespace kinfer::identify {

/// A factor that all accelerometers share, by what each of them reads of gravity.
struct ForceScale {
  double factor = 1.0;    ///< estimated, if there is one
  double sd = 0.0;        ///< with the variation of gravity on Earth
  double log_odds = 0.0;  ///< that there is one, the prior included
  double possible = 0.0;  ///< rms of what it may be where that is not certain: none has a share, by the odds
};

/// `readings`: [m/s²] gravity at rest, one a sensor. Their scatter, which biases and scale errors of their own leave,
/// is unknown: few sensors, or such that disagree, say little of what they share.
ForceScale common_force_scale(std::span<const double> readings);

/// Divides forces and rates by the factors that all sensors share, and records them in the log's `scales`.
void mend_common_scales(MendedLog& log, int threads);

}  // namespace kinfer::identify
