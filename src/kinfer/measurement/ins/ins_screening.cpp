// SPDX-License-Identifier: Apache-2.0
#include "kinfer/measurement/ins/ins_screening.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinfer/base/angle.hpp"
#include "kinfer/base/constants.hpp"

namespace kinfer {
namespace {

constexpr std::array accelerometer_scales{2.0, 3.0, 4.0, 6.0, 8.0, 10.0, 12.0, 16.0, 24.0, 32.0};  // [g]
constexpr std::array gyroscope_scales{125.0, 150.0, 200.0, 245.0,  250.0,  300.0, 400.0,
                                      450.0, 480.0, 500.0, 1000.0, 2000.0, 4000.0};  // [°/s]

template <std::size_t N>
std::vector<double> scaled(const std::array<double, N>& values, double unit) {
  std::vector<double> out;
  for (const double value : values) out.push_back(value * unit);
  return out;
}

bool is_finite(const TriadColumns& triad, std::size_t row) {
  return triad.at(row).allFinite();
}

// Beyond the range of any real sensor: corrupt data, not motion.
constexpr double max_plausible_acceleration = 1e4;                // [m/s²]
constexpr double max_plausible_angular_velocity = 4200 * degree;  // [rad/s]
constexpr double max_plausible_field = 1e6;                       // [µT]

bool is_plausible(const TriadColumns& triad, std::size_t row, double impossible) {
  return is_finite(triad, row) && triad.at(row).cwiseAbs().maxCoeff() < impossible;
}

bool is_zero(const TriadColumns& triad, std::size_t row) {
  return triad.at(row).squaredNorm() <= 0.0;
}

void set_fault(InsSensor& sensor, const std::vector<bool>& rows, Fault fault) {
  for (std::size_t row = 0; row < rows.size(); ++row)
    if (rows[row]) sensor.faults[row] = static_cast<std::uint8_t>(sensor.faults[row] | fault);
}

float largest_magnitude(const std::vector<float>& column) {
  float largest = 0.0f;
  for (const float value : column)
    if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
  return largest;
}

/// Distribution of the rows about the column's peak value. Rows without a value, those of other sensors, are left out.
struct Peak {
  float value = 0.0f;
  std::size_t at_peak = 0, in_runs = 0;  ///< rows with exactly this magnitude; of them equal to the one before
  std::size_t just_below = 0;            ///< rows within 1 % under it
  std::size_t repeats = 0;  ///< rows below the peak equal to the one before: if many, equal rows mean nothing
  std::size_t changes = 0;  ///< rows below the peak that differ from the one before
};

Peak analyse_peak(const std::vector<float>& column) {
  Peak peak{.value = largest_magnitude(column)};
  float before = std::numeric_limits<float>::quiet_NaN();
  for (const float value : column) {
    if (!std::isfinite(value)) continue;
    const float magnitude = std::abs(value);
    const bool repeated = !(value < before) && !(value > before) && std::isfinite(before);
    before = value;
    if (magnitude >= peak.value) {
      ++peak.at_peak;
      if (repeated) ++peak.in_runs;
    } else {
      if (magnitude > 0.99f * peak.value) ++peak.just_below;
      ++(repeated ? peak.repeats : peak.changes);
    }
  }
  return peak;
}

/// A column that hardly ever changes is a constant of the logger or of a broken sensor, not a signal at its range.
bool is_constant(const Peak& peak) {
  constexpr std::size_t rows_per_change = 20;
  return rows_per_change * peak.changes < peak.at_peak + peak.repeats;
}

bool is_full_scale(double value, std::span<const double> full_scales) {
  return std::ranges::any_of(full_scales, [value](double scale) { return std::abs(value / scale - 1.0) < 2e-3; });
}

/// Clipping at an unknown range: far more rows at the peak than in the whole percent below it, in a column whose values
/// otherwise do not repeat (noise-free simulations and sample-and-hold repeat everywhere).
bool is_clipped_at_peak(const Peak& peak, std::size_t rows) {
  return !is_constant(peak) && peak.in_runs >= 8 && peak.in_runs > 2 * peak.just_below && 20 * peak.repeats < rows;
}

}  // namespace

std::vector<bool> find_clipped_rows(const std::vector<float>& column, std::span<const double> full_scales,
                                    double smallest_range) {
  const Peak peak = analyse_peak(column);
  const bool is_range = peak.value > smallest_range && ((peak.in_runs >= 1 && is_full_scale(peak.value, full_scales)) ||
                                                        is_clipped_at_peak(peak, column.size()));
  if (!is_range) return {};
  std::vector<bool> clipped(column.size());
  for (std::size_t row = 0; row < column.size(); ++row) clipped[row] = std::abs(column[row]) >= peak.value;
  return clipped;
}

constexpr std::size_t max_spike_rows = 3;  // consecutive: where spikes are frequent, two or three may follow each other

std::vector<bool> find_spikes(const std::vector<float>& column, double floor) {
  if (column.size() < 5) return {};
  const auto second_difference = [&](std::size_t row) {
    return std::abs(column[row] - 0.5 * (column[row - 1] + column[row + 1]));
  };
  std::vector<double> second_differences;
  const std::size_t stride = std::max<std::size_t>(1, column.size() / 20000);
  for (std::size_t row = 1; row + 1 < column.size(); row += stride)
    if (std::isfinite(second_difference(row))) second_differences.push_back(second_difference(row));
  if (second_differences.empty()) return {};
  const auto rank = second_differences.begin() + static_cast<std::ptrdiff_t>(second_differences.size() * 9 / 10);
  std::ranges::nth_element(second_differences, rank);
  const double limit = std::max(floor, 10.0 * *rank);
  std::vector<bool> spikes(column.size());
  const auto is_spike = [&](double height, float before, float after) {
    return height > limit && std::abs(after - before) < 0.3 * height;
  };
  for (std::size_t width = 1; width <= max_spike_rows; ++width)
    for (std::size_t row = 1; row + width < column.size(); ++row) {
      const float before = column[row - 1], after = column[row + width];
      double lowest = std::numeric_limits<double>::infinity();
      for (std::size_t i = row; i < row + width; ++i) {
        const double height = std::abs(column[i] - 0.5 * (before + after));
        if (!(height > lowest)) lowest = height;
      }
      if (is_spike(lowest, before, after)) std::fill_n(spikes.begin() + static_cast<std::ptrdiff_t>(row), width, true);
    }
  const std::size_t last = column.size() - 1;
  spikes[0] = is_spike(std::abs(column[0] - column[1]), column[1], column[2]);
  spikes[last] = is_spike(std::abs(column[last] - column[last - 1]), column[last - 1], column[last - 2]);
  return spikes;
}

void flag_faults(InsSensor& sensor) {
  const std::size_t rows = sensor.acceleration.axis[0].size();
  sensor.faults.assign(rows, 0);
  for (std::size_t row = 0; row < rows; ++row) {
    unsigned bits = 0;
    if (!is_plausible(sensor.acceleration, row, max_plausible_acceleration) || is_zero(sensor.acceleration, row))
      bits |= acceleration_missing;
    if (!is_plausible(sensor.angular_velocity, row, max_plausible_angular_velocity)) bits |= angular_velocity_missing;
    if (sensor.has_magnetometer() &&
        (!is_plausible(sensor.field, row, max_plausible_field) || is_zero(sensor.field, row)))
      bits |= field_missing;
    sensor.faults[row] = static_cast<std::uint8_t>(bits);
  }
  constexpr double smallest_acceleration_range = 1.2 * standard_gravity, smallest_rate_range = 0.1;  // [m/s²], [rad/s]
  constexpr double acceleration_spike_floor = 30.0, rate_spike_floor = 2.0;                          // [m/s²], [rad/s]
  const auto accelerometer = scaled(accelerometer_scales, standard_gravity),
             gyroscope = scaled(gyroscope_scales, degree);
  for (const auto& axis : sensor.acceleration.axis) {
    set_fault(sensor, find_clipped_rows(axis, accelerometer, smallest_acceleration_range), acceleration_clipped);
    set_fault(sensor, find_spikes(axis, acceleration_spike_floor), acceleration_spike);
  }
  for (const auto& axis : sensor.angular_velocity.axis) {
    set_fault(sensor, find_clipped_rows(axis, gyroscope, smallest_rate_range), angular_velocity_clipped);
    set_fault(sensor, find_spikes(axis, rate_spike_floor), angular_velocity_spike);
  }
}

std::size_t find_usable_end(const InsSensor& sensor) {
  std::size_t row = sensor.rows();
  while (row > 0 && (sensor.faults[row - 1] & (acceleration_missing | angular_velocity_missing))) --row;
  return row;
}

}  // namespace kinfer
