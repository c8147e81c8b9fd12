// SPDX-License-Identifier: Apache-2.0
#include "kinfer/inertial/activity.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/expect.hpp"
#include "kinfer/inertial/rest/rest.hpp"

namespace kinfer {
namespace {

/// rms rate of a sensor in each window, after noise averaging over a tenth of the window.
std::vector<double> window_rates(const InsSensor& sensor, std::span<const double> time, double window) {
  const Vec3 bias = bias_at_rest(rest_periods(sensor, time)).mean;
  const auto windows = static_cast<std::size_t>((time.back() - time.front()) / window) + 1;
  std::vector<double> sum(windows, 0.0), seconds(windows, 0.0);
  LowPass<Vec3> angular_velocity{Vec3::Zero()};
  double last = time.front();  // sample of this sensor: rows between may be those of other sensors
  for (std::size_t row = 1; row < time.size(); ++row) {
    const InsSample s = sample(sensor, time, row);
    if (!s.has_angular_velocity) continue;
    const double dt = std::min(time[row] - last, window);
    last = time[row];
    angular_velocity.add(s.angular_velocity - bias, dt, 0.1 * window);
    const auto w = static_cast<std::size_t>((time[row] - time.front()) / window);
    sum[w] += dt * angular_velocity.value.squaredNorm();
    seconds[w] += dt;
  }
  for (std::size_t w = 0; w < windows; ++w) sum[w] = seconds[w] > 0.0 ? std::sqrt(sum[w] / seconds[w]) : 0.0;
  return sum;
}

bool same_movers(const ActivitySpan& a, const ActivitySpan& b) {
  return std::ranges::equal(a.sensors, b.sensors, {}, &SensorActivity::moves, &SensorActivity::moves);
}

/// Merges `next` into `span`: mean squares weighted by time.
void join(ActivitySpan& span, const ActivitySpan& next) {
  const double before = span.end - span.begin, after = next.end - next.begin;
  for (std::size_t i = 0; i < span.sensors.size(); ++i) {
    double& angular_velocity = span.sensors[i].rms_rate;
    const double other = next.sensors[i].rms_rate;
    angular_velocity =
        std::sqrt((before * angular_velocity * angular_velocity + after * other * other) / (before + after));
  }
  span.end = next.end;
}

}  // namespace

std::vector<ActivitySpan> detect_activity(const InsRecording& recording, const ActivityOptions& options) {
  KINFER_EXPECT(recording.loggers.size() == 1, "{} loggers", recording.loggers.size());
  const auto& time = recording.loggers.front().time;
  if (time.size() < 2) return {};
  std::vector<std::vector<double>> rates;
  for (const InsSensor& sensor : recording.sensors) rates.push_back(window_rates(sensor, time, options.window));
  std::vector<ActivitySpan> spans;
  for (std::size_t w = 0; w < rates.front().size(); ++w) {
    ActivitySpan next{.begin = time.front() + options.window * static_cast<double>(w), .end = 0.0, .sensors = {}};
    next.end = std::min(next.begin + options.window, time.back());
    if (next.end <= next.begin) break;
    for (const auto& of_sensor : rates) next.sensors.push_back({of_sensor[w], of_sensor[w] > options.threshold});
    if (!spans.empty() && same_movers(spans.back(), next))
      join(spans.back(), next);
    else
      spans.push_back(next);
  }
  std::vector<ActivitySpan> joined;
  for (const ActivitySpan& span : spans) {
    const bool is_short = span.end - span.begin < options.shortest;
    if (!joined.empty() && (is_short || same_movers(joined.back(), span)))
      join(joined.back(), span);
    else
      joined.push_back(span);
  }
  return joined;
}

}  // namespace kinfer
