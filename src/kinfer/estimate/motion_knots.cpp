#include "kinfer/estimate/motion_knots.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "kinfer/estimate/ins_blocks.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;

constexpr double finer = 1.0 / std::numbers::sqrt2;
constexpr double finest_knots = 0.025;         // [s]
constexpr double hardly_more = 1.03;           // times what finer knots leave
constexpr double window_length = 10.0;         // [s]
constexpr std::size_t most_windows = 12;       // of a sensor
constexpr double lively = 0.1;                 // of the liveliest's mean square rate: quiet ones dilute
constexpr double part_length = 0.2;            // [s] whose residuals are one number
constexpr double shocks = 0.05;                // of the parts: they do not speak
constexpr Index least_rows = block_nodes + 2;  // an interval: some must be left to show the noise

/// Readings of one sensor in one window: [rate, force], a row each; NaN where one must not be used.
struct Window {
  std::vector<double> time;
  MatrixXd readings;
  double turning = 0.0;  ///< mean square rate
};

Window window_of(const InsSensor& sensor, std::span<const double> time, std::size_t first, std::size_t end) {
  const auto rows = static_cast<Index>(end - first);
  Window window{{time.begin() + static_cast<std::ptrdiff_t>(first), time.begin() + static_cast<std::ptrdiff_t>(end)},
                MatrixXd::Constant(rows, 6, std::numeric_limits<double>::quiet_NaN()),
                0.0};
  for (Index i = 0; i < rows; ++i) {
    const InsSample s = sample(sensor, time, first + static_cast<std::size_t>(i));
    if (!s.has_rate || s.rate_clipped || !s.has_acceleration) continue;
    window.readings.row(i) << s.rate.transpose(), s.acceleration.transpose();
    window.turning += s.rate.squaredNorm() / static_cast<double>(rows);
  }
  return window;
}

std::vector<Window> liveliest_windows(const InsSensor& sensor, std::span<const double> time) {
  std::vector<Window> windows;
  for (std::size_t first = 0; first < time.size();) {
    const auto after = std::ranges::upper_bound(time, time[first] + window_length);
    const auto end = static_cast<std::size_t>(after - time.begin());
    if (time[end - 1] - time[first] > 0.5 * window_length) windows.push_back(window_of(sensor, time, first, end));
    first = end;
  }
  std::ranges::sort(windows, std::ranges::greater{}, &Window::turning);
  if (windows.size() > most_windows) windows.resize(most_windows);
  const double least = windows.empty() ? 0.0 : lively * windows.front().turning;
  std::erase_if(windows, [&](const Window& w) { return w.turning < least; });
  return windows;
}

/// Mean squares of one instrument's residuals in parts of a window.
using Parts = std::array<std::vector<double>, 2>;

void add_residuals(const Window& window, double knots, Parts& parts) {
  const double length = window.time.back() - window.time.front();
  const SplineGrid grid{window.time.front(), knots, std::max<Index>(1, static_cast<Index>(std::ceil(length / knots)))};
  const MatrixXd spline = fit_spline(grid, window.time, window.readings);
  const auto count = static_cast<std::size_t>(std::ceil(length / part_length)) + 1;
  std::array<std::vector<double>, 2> squares{std::vector<double>(count), std::vector<double>(count)};
  std::vector<double> terms(count);
  double rows = 0.0;
  for (std::size_t i = 0; i < window.time.size(); ++i) {
    const auto reading = window.readings.row(static_cast<Index>(i));
    if (!reading.allFinite()) continue;
    const auto part = static_cast<std::size_t>((window.time[i] - grid.begin) / part_length);
    const VectorXd left = reading.transpose() - spline_value(grid, spline, window.time[i]);
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

double rms_without_shocks(std::vector<double> squares) {
  std::ranges::sort(squares);
  const auto kept = squares.size() - static_cast<std::size_t>(shocks * static_cast<double>(squares.size()));
  double sum = 0.0;
  for (std::size_t i = 0; i < kept; ++i) sum += squares[i];
  return kept > 0 ? std::sqrt(sum / static_cast<double>(kept)) : 0.0;
}

/// What splines on such knots leave of a sensor's rate and force.
std::array<double, 2> left_over(const std::vector<Window>& windows, double knots) {
  Parts parts;
  for (const Window& window : windows) add_residuals(window, knots, parts);
  return {rms_without_shocks(std::move(parts[0])), rms_without_shocks(std::move(parts[1]))};
}

/// The widest knots on which this sensor's motion is held; nothing finer than `least` is tried.
double holding_knots(const std::vector<Window>& windows, double widest, double least) {
  double knots = widest;
  auto wide = left_over(windows, knots);
  for (; knots * finer >= least; knots *= finer) {
    const auto fine = left_over(windows, knots * finer);
    if (wide[0] <= hardly_more * fine[0] && wide[1] <= hardly_more * fine[1]) break;
    wide = fine;
  }
  return knots;
}

}  // namespace

double motion_knots(const InsRecording& recording) {
  double knots = widest_knots;
  for (const InsSensor& sensor : recording.sensors) {
    const auto time = recording.time(sensor);
    const double least = std::max(finest_knots, static_cast<double>(least_rows) * typical_period(time));
    const auto windows = liveliest_windows(sensor, time);
    if (windows.empty() || knots * finer < least) continue;
    knots = std::min(knots, std::max(least, finer * holding_knots(windows, knots / finer, least)));
  }
  return knots;
}

}  // namespace kinfer
