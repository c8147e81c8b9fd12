// SPDX-License-Identifier: Apache-2.0
// Headings that are robust to magnetic disturbances: orientations from gyro and gravity alone, with one constant
// heading per segment taken from its magnetometer over the whole recording. Residual heading errors are removed later,
// once the joints between the segments are known.
#pragma once

#include "kinfer/inertial/segment_motion.hpp"

namespace kinfer {

/// From `time` [s] on the heading is another by `angle` [rad]: behind a gap a gyroscope does not know how far it
/// turned.
struct HeadingStep {
  double time = 0.0, angle = 0.0;
};

/// A heading that drifts linearly with time, with steps behind gaps.
struct LinearHeading {
  double angle = 0.0;   ///< [rad] at `middle`, before any step
  double drift = 0.0;   ///< [rad/s]
  double middle = 0.0;  ///< [s]
  std::vector<HeadingStep> steps{};

  double at(double time) const {
    double heading = angle + drift * (time - middle);
    for (const HeadingStep& step : steps)
      if (time >= step.time) heading += step.angle;
    return heading;
  }
};

/// Rotates everything expressed in the world about the vertical.
void turn(SegmentMotion& segment, std::span<const double> time, const LinearHeading& heading);

/// segment_motion with orientations that ignore the magnetometers; a segment with a magnetometer is then rotated by one
/// constant heading to agree with it (north) on average over the recording, or over each part between long gaps.
Result<RecordedMotion> gyro_based_motion(const InsRecording& recording, const SegmentMotionOptions& options = {},
                                         int threads = 0);

/// Whether every sensor has a magnetometer, so that headings are comparable.
bool all_have_magnetometers(const InsRecording& recording);

}  // namespace kinfer
