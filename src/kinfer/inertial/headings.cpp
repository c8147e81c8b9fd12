// SPDX-License-Identifier: Apache-2.0
#include "kinfer/inertial/headings.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/parallel.hpp"
#include "kinfer/inertial/thresholds.hpp"

namespace kinfer {
namespace {

/// Circular mean of the heading of `to` relative to `from`; both levelled by gravity.
double mean_heading(const std::vector<Mat3>& to, const std::vector<Mat3>& from) {
  double sine = 0.0, cosine = 0.0;
  for (std::size_t row = 0; row < to.size(); ++row) {
    const Mat3 turn = to[row] * from[row].transpose();
    sine += turn(1, 0) - turn(0, 1);
    cosine += turn(0, 0) + turn(1, 1);
  }
  return std::atan2(sine, cosine);
}

}  // namespace

void turn(SegmentMotion& segment, std::span<const double> time, const LinearHeading& heading) {
  for (std::size_t row = 0; row < time.size(); ++row) {
    const Mat3 about_up = rot_z(heading.at(time[row]));
    segment.rotation[row] = about_up * segment.rotation[row];
    for (auto* vectors : {&segment.angular_velocity, &segment.angular_acceleration, &segment.acceleration})
      (*vectors)[row] = about_up * (*vectors)[row];
  }
}

bool all_have_magnetometers(const InsRecording& recording) {
  return std::ranges::all_of(recording.sensors, [](const InsSensor& sensor) { return sensor.has_magnetometer(); });
}

Result<RecordedMotion> gyro_based_motion(const InsRecording& recording, const SegmentMotionOptions& options,
                                         int threads) {
  SegmentMotionOptions without_field = options;
  // A bias missed here cannot be compensated by a constant heading: the initial rest must count at any bias.
  without_field.filter = with_max_initial_bias(without_magnetometer(options.filter), inertial::max_initial_gyro_bias);
  KINFER_TRY(motion, segment_motion(recording, without_field, threads));
  parallel_for(motion.segments.size(), threads, [&](std::size_t i) {
    if (!recording.sensors[i].has_magnetometer()) return;
    const auto north_aligned = segment_rotations(motion, recording, recording.sensors[i], options);
    turn(motion.segments[i], motion.time, {.angle = mean_heading(north_aligned, motion.segments[i].rotation)});
  });
  return motion;
}

}  // namespace kinfer
