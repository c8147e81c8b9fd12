// SPDX-License-Identifier: Apache-2.0
#include "kinfer/inertial/diagnosis/attitude_columns.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/angle.hpp"
#include "kinfer/geometry/statistics.hpp"

namespace kinfer {
namespace {

constexpr double vertical_error = 0.03;  // [rad] of a vertical by an accelerometer with a bias of 30 mg

struct TiltSample {
  Vec3 up, columns;
};

/// Means over some rows, in which accelerations partly cancel.
std::vector<TiltSample> samples_of(const InsSensor& sensor) {
  constexpr std::size_t least_rows = 40, most_samples = 4000;
  std::vector<TiltSample> samples;
  const std::size_t rows = std::max(least_rows, sensor.rows() / most_samples);
  for (std::size_t first = 0; first + rows <= sensor.rows(); first += rows) {
    TiltSample mean{Vec3::Zero(), Vec3::Zero()};
    for (std::size_t row = first; row < first + rows; ++row) {
      mean.up += sensor.acceleration.at(row);
      mean.columns += sensor.angular_velocity.at(row) / static_cast<double>(rows);
    }
    if (mean.up.allFinite() && mean.columns.allFinite() && mean.up.norm() > 0.0)
      samples.push_back({mean.up.normalized(), mean.columns});
  }
  return samples;
}

template <class VerticalOf>
double median_angle(const std::vector<TiltSample>& samples, VerticalOf vertical_of) {
  std::vector<double> angles;
  for (const TiltSample& s : samples) angles.push_back(angle_between(s.up, vertical_of(s)));
  return median(std::move(angles));
}

}  // namespace

std::optional<AttitudeFit> attitude_fit(const InsSensor& sensor) {
  constexpr std::size_t least_samples = 50;
  if (!sensor.acceleration.present() || !sensor.angular_velocity.present()) return std::nullopt;
  const auto samples = samples_of(sensor);
  if (samples.size() < least_samples) return std::nullopt;
  Vec3 mean = Vec3::Zero();
  for (const TiltSample& s : samples) mean += s.up;
  if (!(mean.norm() > 0.0)) return std::nullopt;
  const double constant = median_angle(samples, [&](const TiltSample&) { return mean; });
  // Rates are small angles, whose vertical is nearly the sensor's z axis.
  double level = M_PI;
  for (const double up_sign : {1.0, -1.0})
    level = std::min(level, median_angle(samples, [&](const TiltSample&) { return Vec3(0.0, 0.0, up_sign); }));
  double best = M_PI;
  for (const double unit : {1.0, degree})
    for (const int roll : {0, 2})
      for (const double roll_sign : {1.0, -1.0})
        for (const double pitch_sign : {1.0, -1.0})
          for (const double up_sign : {1.0, -1.0})
            best = std::min(
                best, median_angle(samples, [&](const TiltSample& s) {
                  const double r = roll_sign * unit * s.columns[roll], p = pitch_sign * unit * s.columns[1];
                  return Vec3(up_sign * Vec3(-std::sin(p), std::cos(p) * std::sin(r), std::cos(p) * std::cos(r)));
                }));
  // An agreement within the accelerometer's own errors is chance: biases are small angles, too, near a level sensor.
  const auto share = [&](double null) { return std::hypot(best, vertical_error) / std::hypot(null, vertical_error); };
  return AttitudeFit{best, share(level), share(std::min(level, constant))};
}

}  // namespace kinfer
