// SPDX-License-Identifier: Apache-2.0
#include "kinfer/inertial/headings.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/parallel.hpp"
#include "kinfer/inertial/thresholds.hpp"

namespace kinfer {
namespace {

/// Circular mean of the heading of `to` relative to `from` in these rows; both levelled by gravity.
double mean_heading(const std::vector<Mat3>& to, const std::vector<Mat3>& from, std::span<const std::size_t> rows) {
  double sine = 0.0, cosine = 0.0;
  for (const std::size_t row : rows) {
    const Mat3 turn = to[row] * from[row].transpose();
    sine += turn(1, 0) - turn(0, 1);
    cosine += turn(0, 0) + turn(1, 1);
  }
  return std::atan2(sine, cosine);
}

/// The same for each part between the restarts, without the rows of the gaps.
LinearHeading mean_headings(const std::vector<Mat3>& to, const SegmentMotion& from, const RecordedMotion& motion) {
  std::vector<std::vector<std::size_t>> parts(from.restarts.size() + 1);
  for (std::size_t row = 0; row < motion.rows(); ++row)
    if (from.restarts.empty() || motion.usable[row])
      parts[static_cast<std::size_t>(std::ranges::upper_bound(from.restarts, motion.time[row]) - from.restarts.begin())]
          .push_back(row);
  LinearHeading heading{.angle = mean_heading(to, from.rotation, parts.front())};
  double before = heading.angle;
  for (std::size_t part = 1; part < parts.size(); ++part) {
    const double angle = mean_heading(to, from.rotation, parts[part]);
    heading.steps.push_back({from.restarts[part - 1], angle - before});
    before = angle;
  }
  return heading;
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
    turn(motion.segments[i], motion.time, mean_headings(north_aligned, motion.segments[i], motion));
  });
  return motion;
}

}  // namespace kinfer
