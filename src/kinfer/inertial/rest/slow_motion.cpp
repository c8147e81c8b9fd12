// SPDX-License-Identifier: Apache-2.0
#include "kinfer/inertial/rest/slow_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "kinfer/base/constants.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/inertial/rest/steady_rotation.hpp"

namespace kinfer {
namespace {

constexpr double window = 1.0;             // [s] of a median
constexpr std::size_t least_samples = 10;  // in a window

/// Medians of each axis over the windows; `pick` gives the usable samples.
template <class Pick>
std::vector<Vec3> window_medians(const InsSensor& sensor, std::span<const double> time, const Pick& pick) {
  std::vector<Vec3> medians;
  std::array<std::vector<double>, 3> axes;
  double begin = time.empty() ? 0.0 : time.front();
  for (std::size_t row = 0; row < time.size(); ++row) {
    if (time[row] - begin >= window) {
      if (axes[0].size() >= least_samples) medians.emplace_back(median(axes[0]), median(axes[1]), median(axes[2]));
      for (auto& axis : axes) axis.clear();
      begin = time[row];
    }
    if (const auto value = pick(sample(sensor, time, row)))
      for (std::size_t k = 0; k < 3; ++k) axes[k].push_back((*value)[static_cast<Eigen::Index>(k)]);
  }
  return medians;
}

/// Component by component.
Vec3 middle(const std::vector<Vec3>& values) {
  Vec3 result = Vec3::Zero();
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    std::vector<double> of_axis;
    for (const Vec3& value : values) of_axis.push_back(value[axis]);
    if (!of_axis.empty()) result[axis] = median(std::move(of_axis));
  }
  return result;
}

/// Largest length of the deviations from the median, each mapped by `part`, without the share of shocks.
double deviation(const std::vector<Vec3>& values, const Mat3& part) {
  if (values.empty()) return 0.0;
  const Vec3 usual = middle(values);
  std::vector<double> lengths;
  for (const Vec3& value : values) lengths.push_back((part * (value - usual)).norm());
  const auto shocks = static_cast<std::size_t>(max_shock_median_share * static_cast<double>(values.size())) + 1;
  const auto kept = static_cast<std::ptrdiff_t>(values.size() - std::min(values.size(), shocks + 1));
  std::ranges::nth_element(lengths, lengths.begin() + kept);
  return lengths[static_cast<std::size_t>(kept)];
}

/// Of rest, smaller sizes are all alike.
double log_density_at_rest(double size, const LogNormal& of) {
  return log_density(std::max(size, of.median), of);
}

}  // namespace

SlowDeviations slow_deviations(const InsSensor& sensor, std::span<const double> time) {
  const auto rates = window_medians(sensor, time, [](const InsSample& s) {
    return s.has_angular_velocity ? std::optional<Vec3>(s.angular_velocity) : std::nullopt;
  });
  const auto forces = window_medians(sensor, time, [](const InsSample& s) {
    return s.has_acceleration ? std::optional<Vec3>(s.acceleration) : std::nullopt;
  });
  const Vec3 up = middle(forces).normalized();
  const Mat3 about = up * up.transpose(), across = Mat3::Identity() - about;
  return {.rate_across = deviation(rates, across),
          .rate_about = deviation(rates, about),
          .force = deviation(forces, Mat3::Identity())};
}

double slow_motion_log_odds(const SlowDeviations& deviations) {
  constexpr double least = 1e-9;
  const double across = std::max(deviations.rate_across, least), about = std::max(deviations.rate_about, least),
               force = std::max(deviations.force, least);
  const LogNormal drift_about{drift_ratio.median * std::max(across, rest_rate_deviation.median), drift_ratio.spread};
  const LogNormal tilting_force{standard_gravity * across * tilting_time.median, tilting_time.spread};
  const double rest_across = log_density_at_rest(across, rest_rate_deviation),
               rest_about = log_density_at_rest(about, drift_about),
               rest_force = log_density_at_rest(force, rest_force_deviation),
               slews = rest_across + log_density(about, moving_rate_deviation) + rest_force,
               tilts = log_density(across, moving_rate_deviation) +
                       log_density(about, {across, moving_rate_deviation.spread}) + log_density(force, tilting_force);
  const std::array<double, 2> motions{slews, tilts};
  return log_sum(motions) - std::log(2.0) - rest_across - rest_about - rest_force;
}

bool moves_slowly(const InsSensor& sensor, std::span<const double> time, std::span<const RestPeriod> rests) {
  return steady_rate_limit(rests) || slow_motion_log_odds(slow_deviations(sensor, time)) > 0.0;
}

}  // namespace kinfer
