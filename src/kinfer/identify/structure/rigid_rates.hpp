// SPDX-License-Identifier: Apache-2.0
// How far two gyroscopes are from being fastened to one body. On one body the angular velocity c of the one is, for any
// mountings, scale errors, misalignments, biases and a small lag, linear in p of the other: c = C p + D ṗ + b. No
// orientation enters. What is left is noise, which neighbouring moments have not in common, unless the two move
// relative to each other.
#pragma once

#include "kinfer/inertial/segment_motion.hpp"

namespace kinfer::identify {

struct RigidRates {
  double residual = 0.0;  ///< [rad/s] rms of c − C p − D ṗ − b, means over a tenth of a second, largest direction
  double noise = 0.0;     ///< [rad/s] of it, by its fourth differences: what varies faster than at 2 Hz
  double level = 0.0;     ///< [rad/s] rms angular velocity of the faster one
};
RigidRates rigid_rates(const RecordedMotion& motion, const SegmentMotion& parent, const SegmentMotion& child);

}  // namespace kinfer::identify
