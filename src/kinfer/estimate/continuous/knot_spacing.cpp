// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/knot_spacing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "kinfer/estimate/continuous/model/measurement_blocks.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/measurement/ins/ins_screening.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;

constexpr double finer = 1.0 / std::numbers::sqrt2;
constexpr double finest_knot_spacing = 0.025;  // [s]
constexpr double no_further_gain = 1.03;       // ratio to the residual of finer knots: no further gain
constexpr double min_vibration_ratio = 3.0;    // scatter about smooth motion over the instrument's noise
constexpr double window_length = 10.0;         // [s]
constexpr std::size_t most_windows = 12;       // per sensor
constexpr double least_activity = 0.1;   // of the largest mean square angular velocity: quieter windows are left out
constexpr double part_length = 0.2;      // [s] over which residuals are averaged
constexpr double shock_fraction = 0.05;  // fraction of the parts: the largest are ignored
constexpr Index least_rows = block_nodes + 2;  // samples per interval: some redundancy must be left to show the noise

/// Measurements of one sensor in one window: [angular velocity, specific force], one sample per row; NaN if invalid.
struct Window {
  std::vector<double> time;
  MatrixXd measurements;
  double activity = 0.0;  ///< mean square angular velocity [rad²/s²]
};

Window window_of(const InsSensor& sensor, std::span<const double> time, std::size_t first, std::size_t end) {
  Window window{{time.begin() + static_cast<std::ptrdiff_t>(first), time.begin() + static_cast<std::ptrdiff_t>(end)},
                measurement_rows(sensor, time, first, end),
                0.0};
  for (const auto& row : window.measurements.rowwise())
    if (row.allFinite()) window.activity += Vec3(row.head<3>()).squaredNorm() / static_cast<double>(end - first);
  return window;
}

/// Drops rows with single outliers of any size: the splines of a quiet sensor would ring about them for many intervals,
/// and look as if finer knots were needed.
void drop_spikes(Window& window) {
  constexpr double any_size = 1e-9;
  std::vector<float> column(window.time.size());
  std::vector<bool> is_spiky(column.size(), false);
  for (Index c = 0; c < window.measurements.cols(); ++c) {
    for (std::size_t i = 0; i < column.size(); ++i)
      column[i] = static_cast<float>(window.measurements(static_cast<Index>(i), c));
    const std::vector<bool> spikes = find_spikes(column, any_size);
    for (std::size_t i = 0; i < spikes.size(); ++i) is_spiky[i] = is_spiky[i] || spikes[i];
  }
  for (std::size_t i = 0; i < is_spiky.size(); ++i)
    if (is_spiky[i])
      window.measurements.row(static_cast<Index>(i)).setConstant(std::numeric_limits<double>::quiet_NaN());
}

std::vector<Window> most_active_windows(const InsSensor& sensor, std::span<const double> time) {
  std::vector<Window> windows;
  for (std::size_t first = 0; first < time.size();) {
    const auto after = std::ranges::upper_bound(time, time[first] + window_length);
    const auto end = static_cast<std::size_t>(after - time.begin());
    if (time[end - 1] - time[first] > 0.5 * window_length) windows.push_back(window_of(sensor, time, first, end));
    first = end;
  }
  std::ranges::sort(windows, std::ranges::greater{}, &Window::activity);
  if (windows.size() > most_windows) windows.resize(most_windows);
  const double least = windows.empty() ? 0.0 : least_activity * windows.front().activity;
  std::erase_if(windows, [&](const Window& w) { return w.activity < least; });
  for (Window& window : windows) drop_spikes(window);
  return windows;
}

/// Mean squares of one instrument's residuals in parts of a window.
using Parts = std::array<std::vector<double>, 2>;

void add_residuals(const Window& window, double knots, Parts& parts) {
  const double length = window.time.back() - window.time.front();
  const SplineGrid grid{window.time.front(), knots, std::max<Index>(1, static_cast<Index>(std::ceil(length / knots)))};
  const MatrixXd spline = fit_spline(grid, window.time, window.measurements);
  const auto count = static_cast<std::size_t>(std::ceil(length / part_length)) + 1;
  std::array<std::vector<double>, 2> squares{std::vector<double>(count), std::vector<double>(count)};
  std::vector<double> terms(count);
  double rows = 0.0;
  for (std::size_t i = 0; i < window.time.size(); ++i) {
    const auto measurement = window.measurements.row(static_cast<Index>(i));
    if (!measurement.allFinite()) continue;
    const auto part = static_cast<std::size_t>((window.time[i] - grid.begin) / part_length);
    const VectorXd left = measurement.transpose() - spline_value(grid, spline, window.time[i]);
    squares[0][part] += left.head<3>().squaredNorm();
    squares[1][part] += left.tail<3>().squaredNorm();
    terms[part] += 3.0;
    rows += 1.0;
  }
  const double freedom = 1.0 - static_cast<double>(grid.coefficients()) / rows;
  for (std::size_t k = 0; k < count; ++k)
    for (std::size_t i = 0; i < 2; ++i)
      if (terms[k] > 0.0 && freedom > 0.0) parts[i].push_back(squares[i][k] / terms[k] / freedom);
}

double trimmed_rms(std::vector<double> squares) {
  std::ranges::sort(squares);
  const auto kept = squares.size() - static_cast<std::size_t>(shock_fraction * static_cast<double>(squares.size()));
  double sum = 0.0;
  for (std::size_t i = 0; i < kept; ++i) sum += squares[i];
  return kept > 0 ? std::sqrt(sum / static_cast<double>(kept)) : 0.0;
}

/// Residual rms of a sensor's angular velocity and specific force about splines with this knot spacing.
std::array<double, 2> residual_rms(const std::vector<Window>& windows, double knots) {
  Parts parts;
  for (const Window& window : windows) add_residuals(window, knots, parts);
  return {trimmed_rms(std::move(parts[0])), trimmed_rms(std::move(parts[1]))};
}

/// Standard deviation of one row of an instrument by its data sheet, or as it was measured at rest, if that is less: a
/// machine may vibrate at rest, too.
double row_noise(const InstrumentModel& measured, const InstrumentModel& data_sheet, double period) {
  const double density = std::min(measured.noise_density, data_sheet.noise_density),
               resolution = std::max(measured.resolution, data_sheet.resolution);
  return std::hypot(density * std::sqrt(0.5 / period), resolution / std::sqrt(12.0));
}

/// Whether half of the sensors scatter about smooth motion by far more than their noise.
bool machine_vibrates(const InsRecording& recording, const SensorModel& grade) {
  const SensorModel data_sheet = sensor_grade(grade.name).value_or(grade);
  std::array<std::vector<double>, 2> ratios;
  for (const InsSensor& sensor : recording.sensors) {
    const auto time = recording.time(sensor);
    const auto windows = most_active_windows(sensor, time);
    if (windows.empty()) continue;
    const auto scatter = residual_rms(windows, widest_knot_spacing);
    const double period = median_period(time);
    const auto add = [&](std::size_t i, double noise) {
      if (noise > 0.0) ratios[i].push_back(scatter[i] / noise);
    };
    add(0, row_noise(grade.gyroscope, data_sheet.gyroscope, period));
    add(1, row_noise(grade.accelerometer, data_sheet.accelerometer, period));
  }
  return std::ranges::any_of(
      ratios, [](const std::vector<double>& r) { return !r.empty() && median(r) > min_vibration_ratio; });
}

/// Whether splines with these knots leave hardly more of a sensor's measurements than those of widest_knot_spacing.
bool loses_nothing(const std::vector<Window>& windows, double knots) {
  const auto wide = residual_rms(windows, knots), usual = residual_rms(windows, widest_knot_spacing);
  return wide[0] <= no_further_gain * usual[0] && wide[1] <= no_further_gain * usual[1];
}

/// The widest spacing beyond widest_knot_spacing that loses nothing of any sensor, finer by √2 once more.
double widest_without_loss(const InsRecording& recording) {
  double knots = widest_knot_spacing_in_vibration;
  for (const InsSensor& sensor : recording.sensors) {
    const auto windows = most_active_windows(sensor, recording.time(sensor));
    while (knots > widest_knot_spacing && !loses_nothing(windows, knots)) knots *= finer;
  }
  return finer * knots;
}

/// The widest knot spacing that represents this sensor's motion, not finer than `least`.
double sufficient_knot_spacing(const std::vector<Window>& windows, double widest, double least) {
  double knots = widest;
  auto wide = residual_rms(windows, knots);
  for (; knots * finer >= least; knots *= finer) {
    const auto fine = residual_rms(windows, knots * finer);
    if (wide[0] <= no_further_gain * fine[0] && wide[1] <= no_further_gain * fine[1]) break;
    wide = fine;
  }
  return knots;
}

/// By the slowest logger: all sensors share the knots. With a third of the samples that are wanted, of one of five
/// sensors, the normal equations are not positive definite.
double least_knot_spacing(const InsRecording& recording) {
  double slowest = 0.0;
  for (const InsSensor& sensor : recording.sensors) slowest = std::max(slowest, median_period(recording.time(sensor)));
  return std::max(finest_knot_spacing, std::min(widest_knot_spacing, static_cast<double>(least_rows) * slowest));
}

}  // namespace

MatrixXd measurement_rows(const InsSensor& sensor, std::span<const double> time, std::size_t first, std::size_t end) {
  const auto rows = static_cast<Index>(end - first);
  MatrixXd measurements = MatrixXd::Constant(rows, 6, std::numeric_limits<double>::quiet_NaN());
  for (Index i = 0; i < rows; ++i) {
    const InsSample s = sample(sensor, time, first + static_cast<std::size_t>(i));
    if (!s.has_angular_velocity || s.angular_velocity_clipped || !s.has_acceleration) continue;
    measurements.row(i) << s.angular_velocity.transpose(), s.acceleration.transpose();
  }
  return measurements;
}

double select_knot_spacing(const InsRecording& recording) {
  const double least = least_knot_spacing(recording);
  double knots = widest_knot_spacing;
  for (const InsSensor& sensor : recording.sensors) {
    const auto windows = most_active_windows(sensor, recording.time(sensor));
    if (windows.empty() || knots * finer < least) continue;
    knots = std::min(knots, std::max(least, finer * sufficient_knot_spacing(windows, knots / finer, least)));
  }
  return knots;
}

double select_knot_spacing(const InsRecording& recording, const SensorModel& grade) {
  if (machine_vibrates(recording, grade))
    if (const double wide = widest_without_loss(recording); wide > widest_knot_spacing) return wide;
  return select_knot_spacing(recording);
}

}  // namespace kinfer
