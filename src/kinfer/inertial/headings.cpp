#include "kinfer/inertial/headings.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/parallel.hpp"

namespace kinfer {
namespace {

constexpr double largest_bias = 0.09;  // [rad/s] (5 °/s) an axis: three times what cheap gyros have

/// Circular mean of the heading of `to` against `from`; both as close to upright as gravity makes them.
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

void turn(SegmentMotion& segment, std::span<const double> time, const HeadingLine& heading) {
  for (std::size_t row = 0; row < time.size(); ++row) {
    const Mat3 about_up = rot_z(heading.at(time[row]));
    segment.rotation[row] = about_up * segment.rotation[row];
    for (auto* vectors : {&segment.rate, &segment.rate_change, &segment.acceleration})
      (*vectors)[row] = about_up * (*vectors)[row];
  }
}

bool all_have_magnetometers(const InsRecording& recording) {
  return std::ranges::all_of(recording.sensors, [](const InsSensor& sensor) { return sensor.has_magnetometer(); });
}

Result<RecordedMotion> gyro_motion(const InsRecording& recording, const SegmentMotionOptions& options, int threads) {
  SegmentMotionOptions by_gyros = options;
  by_gyros.filter = without_magnetometer(options.filter);
  if (auto* offline = std::get_if<KinferOfflineOptions>(&by_gyros.filter)) {
    // A bias that is not found here, no heading will mend: the rest at the start has to count whatever it reads.
    offline->filter.rest.largest_bias = largest_bias;
    offline->filter.bias_sd = largest_bias / 5.0;
  }
  KINFER_TRY(motion, segment_motion(recording, by_gyros, threads));
  parallel_for(motion.segments.size(), threads, [&](std::size_t i) {
    if (!recording.sensors[i].has_magnetometer()) return;
    const auto pointing = segment_rotations(motion, recording, recording.sensors[i], options);
    turn(motion.segments[i], motion.time, {.angle = mean_heading(pointing, motion.segments[i].rotation)});
  });
  return motion;
}

}  // namespace kinfer
