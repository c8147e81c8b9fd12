// SPDX-License-Identifier: Apache-2.0
#include "kinfer/inertial/rest/slow_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

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

/// Largest distance from the median, without the share of shocks.
double deviation(const std::vector<Vec3>& values) {
  if (values.empty()) return 0.0;
  Vec3 middle;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    std::vector<double> of_axis;
    for (const Vec3& value : values) of_axis.push_back(value[axis]);
    middle[axis] = median(of_axis);
  }
  std::vector<double> distances;
  for (const Vec3& value : values) distances.push_back((value - middle).norm());
  const auto shocks = static_cast<std::size_t>(max_shock_median_share * static_cast<double>(values.size())) + 1;
  const auto kept = static_cast<std::ptrdiff_t>(values.size() - std::min(values.size(), shocks + 1));
  std::ranges::nth_element(distances, distances.begin() + kept);
  return distances[static_cast<std::size_t>(kept)];
}

/// Of rest, smaller sizes are all alike.
double log_density_at_rest(double size, const LogNormal& of) {
  return log_density(std::max(size, of.median), of);
}

}  // namespace

SlowDeviations slow_deviations(const InsSensor& sensor, std::span<const double> time) {
  return {.rate = deviation(window_medians(sensor, time,
                                           [](const InsSample& s) {
                                             return s.has_angular_velocity ? std::optional<Vec3>(s.angular_velocity)
                                                                           : std::nullopt;
                                           })),
          .force = deviation(window_medians(sensor, time, [](const InsSample& s) {
            return s.has_acceleration ? std::optional<Vec3>(s.acceleration) : std::nullopt;
          }))};
}

double slow_motion_log_odds(const SlowDeviations& deviations) {
  constexpr double least = 1e-9;
  const double rate = std::max(deviations.rate, least), force = std::max(deviations.force, least);
  const double rest_rate = log_density_at_rest(rate, rest_rate_deviation),
               rest_force = log_density_at_rest(force, rest_force_deviation),
               moving_rate = log_density(rate, moving_rate_deviation),
               moving_force = log_density(force, moving_force_deviation);
  const std::array<double, 2> motions{moving_rate + moving_force, moving_rate + rest_force};
  return log_sum(motions) - std::log(2.0) - rest_rate - rest_force;
}

bool moves_slowly(const InsSensor& sensor, std::span<const double> time, std::span<const RestPeriod> rests) {
  return steady_rate_limit(rests) || slow_motion_log_odds(slow_deviations(sensor, time)) > 0.0;
}

}  // namespace kinfer
