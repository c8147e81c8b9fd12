// Headings that no steel bends: orientations from gyros and gravity alone, each segment's heading a constant that its
// magnetometer tells on the whole; what remains is left to whoever knows how the segments hang together.
#pragma once

#include "kinfer/inertial/segment_motion.hpp"

namespace kinfer {

/// A heading over time.
struct HeadingLine {
  double angle = 0.0;   ///< [rad] at `middle`
  double drift = 0.0;   ///< [rad/s]
  double middle = 0.0;  ///< [s]

  double at(double time) const { return angle + drift * (time - middle); }
};

/// Turns all that is in the ground about up.
void turn(SegmentMotion& segment, std::span<const double> time, const HeadingLine& heading);

/// segment_motion with orientations that leave the magnetometers alone, and each segment turned by one constant so that
/// it points, over the whole recording, where its magnetometer says (north), if it has one.
Result<RecordedMotion> gyro_motion(const InsRecording& recording, const SegmentMotionOptions& options = {},
                                   int threads = 0);

/// Whether every sensor has a magnetometer, so that headings can be compared at all.
bool all_have_magnetometers(const InsRecording& recording);

}  // namespace kinfer
