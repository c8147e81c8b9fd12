#include "kinfer/inertial/segment_motion.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/parallel.hpp"
#include "kinfer/geometry/fit.hpp"
#include "kinfer/inertial/bridged.hpp"
#include "kinfer/inertial/gaussian_smoothing.hpp"
#include "kinfer/inertial/rest.hpp"

namespace kinfer {
namespace {

// [s] missing readings over which the line between neighbours is believed, and over which it is still better for a
// filter than to start anew
constexpr double longest_bridge = 0.1, longest_filter_bridge = 0.5;

/// Readings of a triad on the common clock: gaps are bridged by straight lines, and said.
struct Resampled {
  std::vector<Vec3> values;
  std::vector<bool> sound;
};

/// Readings at times of their own.
struct Readings {
  std::vector<double> time;
  std::vector<Vec3> value;
  double bin = 0.0;            // [s] over which they are averaged; 0: not at all
  std::size_t last_count = 0;  // readings in the last entry

  void add(double at, const Vec3& v) {
    if (bin > 0.0 && !time.empty() && std::floor(at / bin) <= std::floor(time.back() / bin)) {
      const double share = 1.0 / static_cast<double>(++last_count);
      time.back() += share * (at - time.back());
      value.back() += share * (v - value.back());
      return;
    }
    last_count = 1;
    time.push_back(at);
    value.push_back(v);
  }
};

/// The usable readings of a sensor, `pick`ed from its samples, at the times of `clock`; where the clock is slower than
/// the sensor, means over its period, so that nothing fast is mistaken for something slow.
template <class Pick>
Resampled resampled(const InsSensor& sensor, std::span<const double> time, std::span<const double> clock,
                    const Pick& pick) {
  const double period = clock[1] - clock[0];
  Readings readings{.time = {}, .value = {}, .bin = period > 1.5 * typical_period(time) ? period : 0.0};
  for (std::size_t row = 0; row < time.size(); ++row)
    if (const auto value = pick(sample(sensor, time, row))) readings.add(time[row], *value);
  const std::vector<double>& known_time = readings.time;
  const std::vector<Vec3>& known = readings.value;
  Resampled result{std::vector<Vec3>(clock.size(), Vec3::Zero()), std::vector<bool>(clock.size(), false)};
  std::size_t next = 0;
  for (std::size_t i = 0; i < clock.size() && !known.empty(); ++i) {
    while (next < known.size() && known_time[next] < clock[i]) ++next;
    const std::size_t after = std::min(next, known.size() - 1), before = next > 0 ? next - 1 : 0;
    const double span = known_time[after] - known_time[before];
    const double share = span > 0.0 ? std::clamp((clock[i] - known_time[before]) / span, 0.0, 1.0) : 0.0;
    result.values[i] = known[before] + share * (known[after] - known[before]);
    result.sound[i] = span <= longest_bridge && clock[i] >= known_time[before] - longest_bridge &&
                      clock[i] <= known_time[after] + longest_bridge;
  }
  return result;
}

/// Seconds between the rows of the common clock: those of the sensors; of a long recording a few times as much, because
/// an hour tells enough in rows that are as far apart as the knots of a motion.
double clock_period(std::span<const double> time) {
  constexpr double most_rows = 80000.0, longest = 0.05;  // [s]
  const double period = typical_period(time), rows = (time.back() - time.front()) / period;
  const double stride = std::min(std::ceil(rows / most_rows), std::floor(longest / period));
  return std::max(1.0, stride) * period;
}

std::vector<double> equally_spaced(std::span<const double> time, double period) {
  std::vector<double> clock;
  const auto rows = static_cast<std::size_t>(std::floor((time.back() - time.front()) / period + 1e-6)) + 1;
  for (std::size_t i = 0; i < rows; ++i) clock.push_back(time.front() + static_cast<double>(i) * period);
  return clock;
}

/// Smoothed, or the derivative of it: each axis on its own.
std::vector<Vec3> filtered(const std::vector<Vec3>& signal, const GaussianKernel& kernel,
                           std::vector<double> (*filter)(std::span<const double>, const GaussianKernel&)) {
  std::vector<Vec3> result(signal.size());
  std::vector<double> column(signal.size());
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < signal.size(); ++i) column[i] = signal[i][axis];
    const std::vector<double> out = filter(column, kernel);
    for (std::size_t i = 0; i < signal.size(); ++i) result[i][axis] = out[i];
  }
  return result;
}

double rms_about_mean(const std::vector<Vec3>& signal) {
  Vec3 mean = Vec3::Zero();
  for (const Vec3& v : signal) mean += v / static_cast<double>(signal.size());
  double sum = 0.0;
  for (const Vec3& v : signal) sum += (v - mean).squaredNorm();
  return std::sqrt(sum / static_cast<double>(signal.size()));
}

/// Orientations of the sensor's own rows on the common clock.
std::vector<Mat3> rotations_on(std::span<const double> clock, std::span<const double> time,
                               const std::vector<Quat>& q) {
  std::vector<Mat3> result;
  std::size_t row = 0;
  for (const double t : clock) {
    while (row + 1 < time.size() && time[row + 1] <= t) ++row;
    const std::size_t next = std::min(row + 1, time.size() - 1);
    const double span = time[next] - time[row];
    const double share = span > 0.0 ? std::clamp((t - time[row]) / span, 0.0, 1.0) : 0.0;
    result.push_back(q[row].slerp(share, q[next]).toRotationMatrix());
  }
  return result;
}

/// What a filter makes of a sensor: orientations, and how its gyro errs, true rate = (1 + scale) (rate - bias).
struct Filtered {
  std::vector<Quat> world_q_sensor;  // one a row of the sensor
  std::vector<double> bias_time;     // [s]
  std::vector<Vec3> bias;            // [rad/s]
  Mat3 scale = Mat3::Zero();

  Vec3 true_rate(const Vec3& rate, double time) const {
    const auto after = std::ranges::lower_bound(bias_time, time) - bias_time.begin();
    const Vec3 unbiased = rate - bias[std::min(static_cast<std::size_t>(after), bias.size() - 1)];
    return unbiased + scale * unbiased;
  }
};

/// The smoother knows the gyro's errors from motion as well; the other filters go by the rests.
Filtered run_filter(const InsSensor& recorded, std::span<const double> time, const FilterOptions& filter) {
  const InsSensor sensor = bridged(recorded, time, longest_filter_bridge);
  if (const auto* offline = std::get_if<KinferOfflineOptions>(&filter)) {
    SmoothedMotion smooth = smoothed_motion(sensor, time, *offline);
    if (!smooth.bias.empty())
      return {std::move(smooth.world_q_sensor), std::move(smooth.update_time), std::move(smooth.bias), smooth.scale};
  }
  return {orientations(sensor, time, filter), {time.front()}, {bias_at_rest(rests(sensor, time)).mean}, Mat3::Zero()};
}

/// A segment that stands still is known better by the mean than by any row.
void hold_still(SegmentMotion& segment) {
  segment.still = true;
  std::ranges::fill(segment.rotation, mean_rotation(segment.rotation));
  for (auto* signal : {&segment.gyro, &segment.rate, &segment.rate_change, &segment.acceleration})
    std::ranges::fill(*signal, Vec3::Zero());
}

struct SegmentOnClock {
  SegmentMotion motion;
  std::vector<bool> sound;
};

SegmentOnClock segment_on(std::span<const double> clock, const InsRecording& recording, const InsSensor& sensor,
                          const GaussianKernel& kernel, const SegmentMotionOptions& options) {
  const std::span<const double> time = recording.time(sensor);
  const auto rate = resampled(sensor, time, clock, [](const InsSample& s) {
    return s.has_rate && !s.rate_clipped ? std::optional<Vec3>(s.rate) : std::nullopt;
  });
  const auto force = resampled(sensor, time, clock, [](const InsSample& s) {
    return s.has_acceleration ? std::optional<Vec3>(s.acceleration) : std::nullopt;
  });
  SegmentOnClock result;
  SegmentMotion& m = result.motion;
  m.name = sensor.name;
  const Filtered filter = run_filter(sensor, time, options.filter);
  m.rotation = rotations_on(clock, time, filter.world_q_sensor);
  std::vector<Vec3> rate_ground(clock.size()), acceleration_ground(clock.size());
  for (std::size_t i = 0; i < clock.size(); ++i) {
    m.gyro.push_back(filter.true_rate(rate.values[i], clock[i]));
    rate_ground[i] = m.rotation[i] * m.gyro[i];
    // Eq. (26): its printed matrix turns sensor into ground already, so it is used as printed, not transposed; the
    // gravity that an accelerometer at rest reads has to come off, which (26) does not say.
    acceleration_ground[i] = m.rotation[i] * force.values[i] - Vec3(0.0, 0.0, options.gravity);
    result.sound.push_back(rate.sound[i] && force.sound[i]);
  }
  m.rate = filtered(rate_ground, kernel, smoothed);
  m.rate_change = filtered(rate_ground, kernel, smoothed_derivative);
  m.acceleration = filtered(acceleration_ground, kernel, smoothed);
  if (rms_about_mean(m.rate) < options.still_rate && rms_about_mean(m.acceleration) < options.still_acceleration)
    hold_still(m);
  return result;
}

/// Rows that lie farther than the kernel reaches from every row that any sensor cannot vouch for.
std::vector<bool> usable_rows(const std::vector<SegmentOnClock>& segments, std::size_t rows, int reach) {
  std::vector<bool> usable(rows, true);
  const auto spoil = [&](std::ptrdiff_t from, std::ptrdiff_t to) {
    for (auto i = std::max<std::ptrdiff_t>(from, 0); i <= to && i < static_cast<std::ptrdiff_t>(rows); ++i)
      usable[static_cast<std::size_t>(i)] = false;
  };
  const auto last = static_cast<std::ptrdiff_t>(rows) - 1;
  spoil(0, reach - 1);
  spoil(last - reach + 1, last);
  for (const SegmentOnClock& segment : segments)
    for (std::ptrdiff_t i = 0; i <= last; ++i)
      if (!segment.sound[static_cast<std::size_t>(i)]) spoil(i - reach, i + reach);
  return usable;
}

std::size_t first_moving_row(const RecordedMotion& motion, double still_rate) {
  for (std::size_t row = 0; row < motion.rows(); ++row)
    for (const SegmentMotion& segment : motion.segments)
      if (!segment.still && segment.rate[row].norm() > 2.0 * still_rate) return row;
  return 0;
}

}  // namespace

std::vector<std::string> segment_names(const RecordedMotion& motion) {
  std::vector<std::string> names;
  for (const SegmentMotion& segment : motion.segments) names.push_back(segment.name);
  return names;
}

Result<RecordedMotion> segment_motion(const InsRecording& recording, const SegmentMotionOptions& options, int threads) {
  if (recording.sensors.size() < 2)
    return error("identification needs at least two sensors, found {}", recording.sensors.size());
  RecordedMotion motion;
  const std::span<const double> time = recording.time(recording.sensors.front());
  if (time.size() < 100) return error("identification needs at least 100 rows, found {}", time.size());
  motion.period = clock_period(time);
  motion.time = equally_spaced(time, motion.period);
  const GaussianKernel kernel = gaussian_kernel(options.smoothing, motion.period);
  std::vector<SegmentOnClock> segments(recording.sensors.size());
  parallel_for(segments.size(), threads, [&](std::size_t i) {
    segments[i] = segment_on(motion.time, recording, recording.sensors[i], kernel, options);
  });
  for (std::size_t i = 0; i < segments.size(); ++i)
    if (std::ranges::count(segments[i].sound, true) < 100)
      return error("sensor {} has too few usable rates and specific forces", recording.sensors[i].name);
  motion.usable = usable_rows(segments, motion.rows(), kernel.half);
  for (SegmentOnClock& segment : segments) motion.segments.push_back(std::move(segment.motion));
  motion.first_motion = first_moving_row(motion, options.still_rate);
  return motion;
}

std::vector<Mat3> segment_rotations(const RecordedMotion& motion, const InsRecording& recording,
                                    const InsSensor& sensor, const SegmentMotionOptions& options) {
  const std::span<const double> time = recording.time(sensor);
  const InsSensor whole = bridged(sensor, time, longest_filter_bridge);
  return rotations_on(motion.time, time, orientations(whole, time, options.filter));
}

}  // namespace kinfer
