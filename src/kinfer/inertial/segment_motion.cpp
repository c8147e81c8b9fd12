// SPDX-License-Identifier: Apache-2.0
#include "kinfer/inertial/segment_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "kinfer/base/parallel.hpp"
#include "kinfer/geometry/fit.hpp"
#include "kinfer/inertial/clipped_peaks.hpp"
#include "kinfer/inertial/gap_bridging.hpp"
#include "kinfer/inertial/gaussian_smoothing.hpp"
#include "kinfer/inertial/rest/rest.hpp"
#include "kinfer/inertial/rest/slow_motion.hpp"
#include "kinfer/inertial/rest/steady_rotation.hpp"
#include "kinfer/inertial/thresholds.hpp"

namespace kinfer {
namespace {

/// Measurements of a triad on the common clock: gaps are interpolated linearly and marked as not sound.
struct Resampled {
  std::vector<Vec3> values;
  std::vector<bool> sound;
};

/// Measurements at their own times.
struct BinnedMeasurements {
  std::vector<double> time;
  std::vector<Vec3> value;
  double bin = 0.0;            // [s] averaging interval; 0: none
  std::size_t last_count = 0;  // measurements averaged in the last entry

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

/// The usable measurements of a sensor, `pick`ed from its samples, at the times of `clock`; if the clock is slower than
/// the sensor, means over the clock's period to prevent aliasing.
template <class Pick>
Resampled resample(const InsSensor& sensor, std::span<const double> time, std::span<const double> clock,
                   const Pick& pick) {
  const double period = clock[1] - clock[0];
  BinnedMeasurements measurements{
      .time = {}, .value = {}, .bin = period > inertial::min_averaging_ratio * median_period(time) ? period : 0.0};
  for (std::size_t row = 0; row < time.size(); ++row)
    if (const auto value = pick(sample(sensor, time, row))) measurements.add(time[row], *value);
  const std::vector<double>& known_time = measurements.time;
  const std::vector<Vec3>& known = measurements.value;
  Resampled result{std::vector<Vec3>(clock.size(), Vec3::Zero()), std::vector<bool>(clock.size(), false)};
  std::size_t next = 0;
  for (std::size_t i = 0; i < clock.size() && !known.empty(); ++i) {
    while (next < known.size() && known_time[next] < clock[i]) ++next;
    const std::size_t after = std::min(next, known.size() - 1), before = next > 0 ? next - 1 : 0;
    const double span = known_time[after] - known_time[before];
    const double share = span > 0.0 ? std::clamp((clock[i] - known_time[before]) / span, 0.0, 1.0) : 0.0;
    result.values[i] = known[before] + share * (known[after] - known[before]);
    result.sound[i] = span <= inertial::max_gap && clock[i] >= known_time[before] - inertial::max_gap &&
                      clock[i] <= known_time[after] + inertial::max_gap;
  }
  return result;
}

struct Span {
  double begin = std::numeric_limits<double>::infinity(), end = -std::numeric_limits<double>::infinity();  // [s]

  bool holds(double time) const { return begin <= time && time <= end; }
};

bool has_rate(const InsSensor& sensor, std::size_t row) {
  return !(sensor.faults[row] & (angular_velocity_missing | angular_velocity_spike));
}

/// From a sensor's first to its last rate.
Span measured_span(const InsSensor& sensor, std::span<const double> time) {
  Span span;
  for (std::size_t row = 0; row < time.size(); ++row)
    if (has_rate(sensor, row)) span = {std::min(span.begin, time[row]), time[row]};
  return span;
}

/// Middles of the gaps that no filter integrates across.
std::vector<double> restarts_of(const InsSensor& sensor, std::span<const double> time) {
  std::vector<double> restarts;
  std::optional<double> last;
  for (std::size_t row = 0; row < time.size(); ++row) {
    if (!has_rate(sensor, row)) continue;
    if (last && time[row] - *last > inertial::max_filter_gap) restarts.push_back(0.5 * (*last + time[row]));
    last = time[row];
  }
  return restarts;
}

/// Period of the common clock [s]: that of the sensors; for a long recording a multiple of it, because rows spaced as
/// widely as the spline knots of the motion are sufficient.
double clock_period(std::span<const double> time) {
  const double period = median_period(time), rows = (time.back() - time.front()) / period;
  const double stride =
      std::min(std::ceil(rows / inertial::max_clock_rows), std::floor(inertial::max_clock_period / period));
  return std::max(1.0, stride) * period;
}

std::vector<double> uniform_clock(std::span<const double> time, double period) {
  std::vector<double> clock;
  const auto rows = static_cast<std::size_t>(std::floor((time.back() - time.front()) / period + 1e-6)) + 1;
  for (std::size_t i = 0; i < rows; ++i) clock.push_back(time.front() + static_cast<double>(i) * period);
  return clock;
}

/// Smoothed signal or its derivative, per axis.
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

/// Root mean square about the mean, without the share `trimmed` of the rows that are farthest from it.
double rms_about_mean(const std::vector<Vec3>& signal, double trimmed = 0.0) {
  Vec3 mean = Vec3::Zero();
  for (const Vec3& v : signal) mean += v / static_cast<double>(signal.size());
  std::vector<double> squares;
  for (const Vec3& v : signal) squares.push_back((v - mean).squaredNorm());
  const auto kept = static_cast<std::ptrdiff_t>((1.0 - trimmed) * static_cast<double>(squares.size()));
  if (kept < std::ssize(squares)) std::ranges::nth_element(squares, squares.begin() + kept);
  return std::sqrt(std::accumulate(squares.begin(), squares.begin() + kept, 0.0) / static_cast<double>(kept));
}

/// Orientations at the sensor's rows, interpolated to the common clock.
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

void subtract(InsSensor& sensor, const Vec3& bias) {
  for (std::size_t k = 0; k < 3; ++k)
    for (float& rate : sensor.angular_velocity.axis[k])
      rate = static_cast<float>(double{rate} - bias[static_cast<Eigen::Index>(k)]);
}

/// Where the sensor also rotates steadily, its bias is known before: the filter takes no such rate for one.
FilterOutput filter_rotating_sensor(InsSensor sensor, std::span<const double> time, const FilterOptions& filter,
                                    std::span<const RestPeriod> rests, double limit) {
  const Vec3 bias = bias_at_rest(rests).mean;
  subtract(sensor, bias);
  FilterOutput output = run_filter(sensor, time, with_max_initial_bias(filter, limit));
  for (Vec3& b : output.bias) b += bias;
  return output;
}

/// Of the options, started with the sensor's bias where that is known and no rest tells it.
FilterOptions filter_for(const InsSensor& sensor, const SegmentMotionOptions& options,
                         std::span<const RestPeriod> rests) {
  const auto known = std::ranges::find(options.biases, sensor.name, &GyroscopeBias::sensor);
  if (known == options.biases.end() || !rests.empty()) return options.filter;
  return with_bias(options.filter, known->mean, known->sd);
}

/// With filters that do not estimate the gyro errors, one bias comes from the rests.
FilterOutput filter_sensor(const InsSensor& recorded, std::span<const double> time, const FilterOptions& filter,
                           std::span<const RestPeriod> rests) {
  const InsSensor sensor = bridge_gaps(restore_clipped_peaks(recorded, time), time, inertial::max_filter_gap);
  const auto limit = steady_rate_limit(rests);
  FilterOutput output =
      limit ? filter_rotating_sensor(sensor, time, filter, rests, *limit) : run_filter(sensor, time, filter);
  if (output.bias.empty()) {
    output.bias_time = {time.front()};
    output.bias = {bias_at_rest(rests).mean};
  }
  return output;
}

/// For a stationary segment the mean is more accurate than any row.
void set_stationary(SegmentMotion& segment) {
  segment.still = true;
  std::ranges::fill(segment.rotation, mean_rotation(segment.rotation));
  for (auto* signal : {&segment.gyro, &segment.angular_velocity, &segment.angular_acceleration, &segment.acceleration})
    std::ranges::fill(*signal, Vec3::Zero());
}

struct ResampledSegment {
  SegmentMotion motion;
  std::vector<bool> sound;
};

ResampledSegment resample_segment(std::span<const double> clock, const InsRecording& recording, const InsSensor& sensor,
                                  const GaussianKernel& kernel, const SegmentMotionOptions& options,
                                  std::span<const RestPeriod> rests) {
  const std::span<const double> time = recording.time(sensor);
  const auto angular_velocity = resample(sensor, time, clock, [](const InsSample& s) {
    return s.has_angular_velocity && !s.angular_velocity_clipped ? std::optional<Vec3>(s.angular_velocity)
                                                                 : std::nullopt;
  });
  const auto force = resample(sensor, time, clock, [](const InsSample& s) {
    return s.has_acceleration ? std::optional<Vec3>(s.acceleration) : std::nullopt;
  });
  ResampledSegment result;
  SegmentMotion& m = result.motion;
  m.name = sensor.name;
  const FilterOutput filter = filter_sensor(sensor, time, filter_for(sensor, options, rests), rests);
  m.rotation = rotations_on(clock, time, filter.world_q_sensor);
  m.restarts = restarts_of(sensor, time);
  const Span measured = measured_span(sensor, time);
  std::vector<Vec3> rate_world(clock.size(), Vec3::Zero()), acceleration_world(clock.size(), Vec3::Zero());
  for (std::size_t i = 0; i < clock.size(); ++i) {
    result.sound.push_back(angular_velocity.sound[i] && force.sound[i]);
    if (!result.sound.back() && !measured.holds(clock[i])) {  // as if it stood still before and after
      m.gyro.push_back(Vec3::Zero());
      continue;
    }
    m.gyro.push_back(filter.true_rate(angular_velocity.values[i], clock[i]));
    rate_world[i] = m.rotation[i] * m.gyro[i];
    // Eq. (26): its printed matrix already transforms from sensor to world, so it is not transposed; the gravity
    // measured by an accelerometer at rest must be subtracted, which (26) omits.
    acceleration_world[i] = m.rotation[i] * force.values[i] - Vec3(0.0, 0.0, options.gravity);
  }
  m.angular_velocity = filtered(rate_world, kernel, smoothed);
  m.angular_acceleration = filtered(rate_world, kernel, smoothed_derivative);
  m.acceleration = filtered(acceleration_world, kernel, smoothed);
  if (rms_about_mean(m.angular_velocity) < options.stationary_rate &&
      rms_about_mean(m.acceleration, inertial::max_shock_share) < options.stationary_acceleration &&
      !moves_slowly(sensor, time, rests))
    set_stationary(m);
  return result;
}

/// Why there are no rows in which all sensors measure.
tl::unexpected<Error> no_common_rows(const InsRecording& recording) {
  const InsSensor *first_to_end = nullptr, *last_to_begin = nullptr;
  Span common{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  for (const InsSensor& sensor : recording.sensors) {
    const Span span = measured_span(sensor, recording.time(sensor));
    if (span.begin > common.begin) common.begin = span.begin, last_to_begin = &sensor;
    if (span.end < common.end) common.end = span.end, first_to_end = &sensor;
  }
  if (common.begin >= common.end)
    return error(
        "{} begins to measure at {:.2f} s, after {} ended at {:.2f} s: all sensors must measure at the "
        "same time; --sensors names some of them",
        last_to_begin->name, common.begin, first_to_end->name, common.end);
  return error("all sensors measure at one time in fewer than {} rows; --sensors names some of them",
               inertial::min_common_rows);
}

/// Rows farther than the kernel half width from every row that is not sound in some sensor.
std::vector<bool> usable_rows(const std::vector<ResampledSegment>& segments, std::size_t rows, int reach) {
  std::vector<bool> usable(rows, true);
  const auto mark_unusable = [&](std::ptrdiff_t from, std::ptrdiff_t to) {
    for (auto i = std::max<std::ptrdiff_t>(from, 0); i <= to && i < static_cast<std::ptrdiff_t>(rows); ++i)
      usable[static_cast<std::size_t>(i)] = false;
  };
  const auto last = static_cast<std::ptrdiff_t>(rows) - 1;
  mark_unusable(0, reach - 1);
  mark_unusable(last - reach + 1, last);
  for (const ResampledSegment& segment : segments)
    for (std::ptrdiff_t i = 0; i <= last; ++i)
      if (!segment.sound[static_cast<std::size_t>(i)]) mark_unusable(i - reach, i + reach);
  return usable;
}

std::size_t first_moving_row(const RecordedMotion& motion, double stationary_rate) {
  for (std::size_t row = 0; row < motion.rows(); ++row)
    for (const SegmentMotion& segment : motion.segments)
      if (!segment.still && segment.angular_velocity[row].norm() > inertial::first_motion_factor * stationary_rate)
        return row;
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
  motion.gravity = options.gravity;
  const std::span<const double> time = recording.time(recording.sensors.front());
  if (time.size() < inertial::min_rows)
    return error("identification needs at least {} rows, found {}", inertial::min_rows, time.size());
  motion.period = clock_period(time);
  motion.time = uniform_clock(time, motion.period);
  const GaussianKernel kernel = gaussian_kernel(options.smoothing, motion.period);
  std::vector<ResampledSegment> segments(recording.sensors.size());
  const auto rests = rest_periods_of(recording);
  parallel_for(segments.size(), threads, [&](std::size_t i) {
    segments[i] = resample_segment(motion.time, recording, recording.sensors[i], kernel, options, rests[i]);
  });
  for (std::size_t i = 0; i < segments.size(); ++i)
    if (std::ranges::count(segments[i].sound, true) < static_cast<std::ptrdiff_t>(inertial::min_rows))
      return error("sensor {} has too few usable rates and specific forces", recording.sensors[i].name);
  motion.usable = usable_rows(segments, motion.rows(), kernel.half);
  if (std::ranges::count(motion.usable, true) < static_cast<std::ptrdiff_t>(inertial::min_common_rows))
    return no_common_rows(recording);
  for (ResampledSegment& segment : segments) motion.segments.push_back(std::move(segment.motion));
  motion.first_motion_row = first_moving_row(motion, options.stationary_rate);
  return motion;
}

std::vector<Mat3> segment_rotations(const RecordedMotion& motion, const InsRecording& recording,
                                    const InsSensor& sensor, const SegmentMotionOptions& options) {
  const std::span<const double> time = recording.time(sensor);
  const InsSensor whole = bridge_gaps(restore_clipped_peaks(sensor, time), time, inertial::max_filter_gap);
  return rotations_on(motion.time, time,
                      estimate_orientations(whole, time, filter_for(sensor, options, rest_periods(sensor, time))));
}

}  // namespace kinfer
