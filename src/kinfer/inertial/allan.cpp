// SPDX-License-Identifier: Apache-2.0
#include "kinfer/inertial/allan.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/geometry/statistics.hpp"

namespace kinfer {
namespace {

constexpr double flicker_floor = 0.664;  // √(2 ln 2 / π): floor of the Allan deviation over bias instability

/// σ²(m τ0) = Σ (θ[k+2m] - 2 θ[k+m] + θ[k])² / (2 (m τ0)² (N - 2m)), θ the integral of the signal.
double overlapping_variance(std::span<const double> integral, std::size_t m, double tau) {
  double sum = 0.0;
  const std::size_t n = integral.size() - 2 * m;
  for (std::size_t k = 0; k < n; ++k) {
    const double bend = integral[k + 2 * m] - 2.0 * integral[k + m] + integral[k];
    sum += bend * bend;
  }
  return sum / (2.0 * tau * tau * static_cast<double>(n));
}

}  // namespace

std::vector<AllanPoint> allan_deviation(std::span<const double> values, double period) {
  constexpr double step = 1.3335;  // 10^(1/8)
  std::vector<AllanPoint> curve;
  if (values.size() < 9 || !(period > 0.0)) return curve;
  const double average = mean(values);  // no effect on the result, but keeps the integral small
  std::vector<double> integral(values.size() + 1, 0.0);
  for (std::size_t i = 0; i < values.size(); ++i) integral[i + 1] = integral[i] + (values[i] - average) * period;
  for (std::size_t m = 1; 3 * m <= values.size();
       m = std::max(m + 1, static_cast<std::size_t>(std::lround(static_cast<double>(m) * step)))) {
    const double tau = static_cast<double>(m) * period;
    curve.push_back({tau, std::sqrt(overlapping_variance(integral, m, tau))});
  }
  return curve;
}

AllanCoefficients allan_coefficients(std::span<const AllanPoint> curve) {
  AllanCoefficients figures;
  if (curve.empty()) return figures;
  std::vector<double> densities;
  for (const AllanPoint& point : curve)
    if (point.tau <= 1.0 || densities.empty()) densities.push_back(point.deviation * std::sqrt(2.0 * point.tau));
  figures.noise_density = median(densities);
  const auto lowest = std::ranges::min_element(curve, {}, &AllanPoint::deviation);
  figures.bias_instability = lowest->deviation / flicker_floor;
  figures.instability_tau = lowest->tau;
  figures.reaches_floor = lowest + 1 != curve.end() && curve.back().deviation > 1.2 * lowest->deviation;
  return figures;
}

}  // namespace kinfer
