// SPDX-License-Identifier: Apache-2.0
// Whether a series of checks has changed: a two-sided CUSUM (Page 1954) that starts itself (Hawkins 1987). Each value
// is compared with the mean and spread of those before it, so that no period has to be declared healthy.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace kinfer::fleet {

/// Independent standard Gaussian numbers where all values are draws of one Gaussian, whatever its mean and spread:
/// Φ⁻¹(F_{t−2}(√((t−1)/t) (x_t − mean_{t−1}) / sd_{t−1})), F the Student distribution; 0 for the first two.
std::vector<double> standardised_innovations(std::span<const double> values);

struct ChartAlarm {
  std::size_t noticed = 0;  ///< the value at which the sum passed the limit
  bool rises = false;
  double statistic = 0.0;  ///< largest sum from then on
};

/// The first alarm of the series.
std::optional<ChartAlarm> cusum_alarm(std::span<const double> innovations, double limit);

/// The value that a change began with which was noticed at `noticed`: the most likely one, which divides the values up
/// to then into two parts with the largest difference of means for their numbers. At least two values come before it.
std::size_t change_point(std::span<const double> values, std::size_t noticed);

/// Average number of checks until a false alarm of the two-sided chart: Siegmund's approximation (1985), with the
/// excess over the boundary of a Gaussian walk.
double average_run_length(double limit);

/// The limit with that average run length.
double limit_for_run_length(double run_length);

}  // namespace kinfer::fleet
