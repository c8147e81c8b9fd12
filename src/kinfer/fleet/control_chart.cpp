// SPDX-License-Identifier: Apache-2.0
#include "kinfer/fleet/control_chart.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/fleet/thresholds.hpp"
#include "kinfer/geometry/student.hpp"

namespace kinfer::fleet {
namespace {

constexpr double largest_innovation = 6.0;  // one check alone must not carry a series over the limit for years

}  // namespace

std::vector<double> standardised_innovations(std::span<const double> values) {
  std::vector<double> innovations(values.size(), 0.0);
  double mean = 0.0, squares = 0.0;  // of the values before
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto before = static_cast<double>(i);
    const double difference = values[i] - mean;
    if (i >= 2 && squares > 0.0) {
      const double sd = std::sqrt(squares / (before - 1.0));
      const double z =
          gaussian_of_student(difference / sd * std::sqrt(before / (before + 1.0)), static_cast<int>(i) - 1);
      innovations[i] = std::clamp(z, -largest_innovation, largest_innovation);
    }
    mean += difference / (before + 1.0);
    squares += difference * (values[i] - mean);
  }
  return innovations;
}

std::optional<ChartAlarm> cusum_alarm(std::span<const double> innovations, double limit) {
  std::optional<ChartAlarm> alarm;
  for (const double sign : {1.0, -1.0}) {
    double sum = 0.0;
    for (std::size_t i = 0; i < innovations.size(); ++i) {
      sum = std::max(0.0, sum + sign * innovations[i] - thresholds::chart_allowance);
      if (sum <= limit) continue;
      if (!alarm || i < alarm->noticed) alarm = ChartAlarm{.noticed = i, .rises = sign > 0.0, .statistic = sum};
      break;
    }
  }
  return alarm;
}

std::size_t change_point(std::span<const double> values, std::size_t noticed) {
  const std::size_t n = noticed + 1;
  double total = 0.0;
  for (std::size_t i = 0; i < n; ++i) total += values[i] - values[0];  // from the first, so that digits are kept
  std::size_t best = noticed;
  double most = -1.0, before = 0.0;
  for (std::size_t k = 1; k < n; ++k) {
    before += values[k - 1] - values[0];
    const auto first = static_cast<double>(k), rest = static_cast<double>(n - k);
    const double difference = before / first - (total - before) / rest;
    const double gain = difference * difference * first * rest / static_cast<double>(n);
    if (k >= 2 && gain > most) best = k, most = gain;
  }
  return best;
}

double average_run_length(double limit) {
  constexpr double excess = 1.166;  // twice the mean excess of a Gaussian walk over a boundary, 0.583
  const double rate = 2.0 * thresholds::chart_allowance, height = rate * (limit + excess);
  const double one_sided = 2.0 * (std::expm1(height) - height) / (rate * rate);
  return 0.5 * one_sided;
}

double limit_for_run_length(double run_length) {
  double low = 0.0, high = 60.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (average_run_length(middle) < run_length ? low : high) = middle;
  }
  return high;
}

}  // namespace kinfer::fleet
