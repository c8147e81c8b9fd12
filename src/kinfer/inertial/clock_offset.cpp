// SPDX-License-Identifier: Apache-2.0
#include "kinfer/inertial/clock_offset.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/expect.hpp"
#include "kinfer/inertial/rest/rest.hpp"
#include "kinfer/inertial/thresholds.hpp"

namespace kinfer {
namespace {

constexpr double coarse_rate = 2.0, fine_rate = 50.0;  // [Hz]

/// Mean magnitude of the angular rate in time bins of equal length, from the logger's first row on.
std::vector<double> binned_rate(const InsSensor& sensor, std::span<const double> time, double bins_per_second) {
  const Vec3 bias = bias_at_rest(rest_periods(sensor, time)).mean;
  std::vector<double> sum(static_cast<std::size_t>((time.back() - time.front()) * bins_per_second) + 1, 0.0),
      n(sum.size(), 0.0);
  for (std::size_t row = 0; row < time.size(); ++row) {
    const InsSample s = sample(sensor, time, row);
    if (!s.has_angular_velocity) continue;
    const auto bin = static_cast<std::size_t>((time[row] - time.front()) * bins_per_second);
    sum[bin] += (s.angular_velocity - bias).norm();
    n[bin] += 1.0;
  }
  for (std::size_t bin = 0; bin < sum.size(); ++bin)
    sum[bin] = n[bin] > 0.0 ? sum[bin] / n[bin] : (bin > 0 ? sum[bin - 1] : 0.0);
  return sum;
}

/// Correlation coefficient of a[i] with b[i - lag] over their overlap; 0 if that is too short or without motion.
double correlation_at(std::span<const double> a, std::span<const double> b, std::ptrdiff_t lag, std::size_t least) {
  const auto begin = std::max<std::ptrdiff_t>(0, lag);
  const auto end = std::min<std::ptrdiff_t>(std::ssize(a), std::ssize(b) + lag);
  if (end - begin < static_cast<std::ptrdiff_t>(least)) return 0.0;
  double sa = 0.0, sb = 0.0, saa = 0.0, sbb = 0.0, sab = 0.0;
  for (std::ptrdiff_t i = begin; i < end; ++i) {
    const double x = a[static_cast<std::size_t>(i)], y = b[static_cast<std::size_t>(i - lag)];
    sa += x, sb += y, saa += x * x, sbb += y * y, sab += x * y;
  }
  const double n = static_cast<double>(end - begin);
  const double va = saa - sa * sa / n, vb = sbb - sb * sb / n;
  constexpr double still = 1e-9;
  return va > still && vb > still ? (sab - sa * sb / n) / std::sqrt(va * vb) : 0.0;
}

struct Match {
  std::ptrdiff_t lag = 0;
  double correlation = 0.0;
};

Match best_lag(std::span<const double> a, std::span<const double> b, std::ptrdiff_t from, std::ptrdiff_t to,
               double sampling_rate) {
  Match best;
  for (std::ptrdiff_t lag = from; lag <= to; ++lag) {
    const double c = correlation_at(a, b, lag, static_cast<std::size_t>(inertial::min_overlap * sampling_rate));
    if (c > best.correlation) best = {lag, c};
  }
  return best;
}

/// Lag of the vertex of the parabola through the correlations at lag - 1, lag, lag + 1.
double vertex(std::span<const double> a, std::span<const double> b, std::ptrdiff_t lag) {
  const auto least = static_cast<std::size_t>(inertial::min_overlap * fine_rate);
  const double before = correlation_at(a, b, lag - 1, least), at = correlation_at(a, b, lag, least);
  const double after = correlation_at(a, b, lag + 1, least), bend = before - 2.0 * at + after;
  const double shift = bend < 0.0 ? 0.5 * (before - after) / bend : 0.0;
  return static_cast<double>(lag) + std::clamp(shift, -1.0, 1.0);
}

ClockOffset pair_clock_offset(const InsSensor& a, std::span<const double> time_a, const InsSensor& b,
                              std::span<const double> time_b) {
  const auto coarse_a = binned_rate(a, time_a, coarse_rate), coarse_b = binned_rate(b, time_b, coarse_rate);
  const Match rough = best_lag(coarse_a, coarse_b, -std::ssize(coarse_b), std::ssize(coarse_a), coarse_rate);
  if (rough.correlation <= 0.0) return {};
  const auto fine_a = binned_rate(a, time_a, fine_rate), fine_b = binned_rate(b, time_b, fine_rate);
  constexpr auto ratio = static_cast<std::ptrdiff_t>(fine_rate / coarse_rate);
  const Match near = best_lag(fine_a, fine_b, (rough.lag - 1) * ratio, (rough.lag + 1) * ratio, fine_rate);
  if (near.correlation <= 0.0) return {};
  return {time_a.front() - time_b.front() + vertex(fine_a, fine_b, near.lag) / fine_rate, near.correlation};
}

}  // namespace

ClockOffset estimate_clock_offset(const InsRecording& recording, std::size_t reference, std::size_t other) {
  KINFER_EXPECT(reference < recording.loggers.size() && other < recording.loggers.size());
  ClockOffset best;
  for (const InsSensor& a : recording.sensors)
    for (const InsSensor& b : recording.sensors) {
      if (a.logger != reference || b.logger != other) continue;
      const ClockOffset offset = pair_clock_offset(a, recording.time(a), b, recording.time(b));
      if (offset.correlation > best.correlation) best = offset;
    }
  return best;
}

}  // namespace kinfer
