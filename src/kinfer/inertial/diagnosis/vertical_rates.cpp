// SPDX-License-Identifier: Apache-2.0
#include "kinfer/inertial/diagnosis/vertical_rates.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kinfer {
namespace {

constexpr double vertical_bin = 0.25;  // [s]
constexpr std::size_t min_common_bins = 20;
constexpr double most_bins = 40000.0;

/// Means over bins since `begin`; NaN where the sensor has no sample.
std::vector<double> vertical_rates(const InsSensor& sensor, std::span<const double> time, double begin, double width,
                                   std::size_t bins) {
  std::vector<double> sum(bins, 0.0), n(bins, 0.0);
  for (std::size_t row = 0; row < time.size(); ++row) {
    const Vec3 f = sensor.acceleration.at(row), w = sensor.angular_velocity.at(row);
    const double k = (time[row] - begin) / width;
    if (!(k >= 0.0 && k < static_cast<double>(bins)) || !f.allFinite() || !w.allFinite() || !(f.norm() > 0.0)) continue;
    sum[static_cast<std::size_t>(k)] += w.dot(f) / f.norm(), n[static_cast<std::size_t>(k)] += 1.0;
  }
  for (std::size_t k = 0; k < bins; ++k) sum[k] = n[k] > 0.0 ? sum[k] / n[k] : std::numeric_limits<double>::quiet_NaN();
  return sum;
}

VerticalAgreement agreement_of(const std::vector<double>& a, const std::vector<double>& b) {
  double n = 0.0, sa = 0.0, sb = 0.0, aa = 0.0, bb = 0.0, ab = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    if (!std::isfinite(a[k]) || !std::isfinite(b[k])) continue;
    n += 1.0, sa += a[k], sb += b[k], aa += a[k] * a[k], bb += b[k] * b[k], ab += a[k] * b[k];
  }
  if (n < static_cast<double>(min_common_bins)) return {};
  const double covariance = ab / n - sa * sb / (n * n);
  const double size = std::sqrt(std::max((aa / n - sa * sa / (n * n)) * (bb / n - sb * sb / (n * n)), 0.0));
  return size > 0.0 ? VerticalAgreement{covariance / size, std::sqrt(std::abs(covariance))} : VerticalAgreement{};
}

}  // namespace

std::vector<std::vector<VerticalAgreement>> vertical_agreement(const InsRecording& recording) {
  const std::size_t n = recording.sensors.size();
  std::vector<std::vector<VerticalAgreement>> agreement(n, std::vector<VerticalAgreement>(n));
  double begin = std::numeric_limits<double>::infinity(), end = -begin;
  for (const InsLogger& logger : recording.loggers)
    if (!logger.time.empty()) begin = std::min(begin, logger.time.front()), end = std::max(end, logger.time.back());
  if (!(end > begin)) return agreement;
  const double width = std::max(vertical_bin, (end - begin) / most_bins);
  const auto bins = static_cast<std::size_t>((end - begin) / width) + 1;
  std::vector<std::vector<double>> rates;
  for (const InsSensor& sensor : recording.sensors)
    rates.push_back(sensor.acceleration.present() && sensor.angular_velocity.present()
                        ? vertical_rates(sensor, recording.time(sensor), begin, width, bins)
                        : std::vector<double>(bins, std::numeric_limits<double>::quiet_NaN()));
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j) agreement[i][j] = agreement[j][i] = agreement_of(rates[i], rates[j]);
  return agreement;
}

}  // namespace kinfer
