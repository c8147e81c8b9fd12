// SPDX-License-Identifier: Apache-2.0
#include "kinfer/inertial/sampling_grid.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/geometry/statistics.hpp"
#include "kinfer/inertial/thresholds.hpp"

namespace kinfer {
namespace {

constexpr std::size_t window_rows = 8, cubic_terms = 4;
constexpr std::size_t most_grid_windows = 4000;  // a sensor: more do not change the decision

/// Sample numbers, counted on through gaps, and the stretch between gaps that each row belongs to.
struct Numbering {
  std::vector<double> number;
  std::vector<std::size_t> stretch;
};

/// [s] Steps longer than this are gaps: many times the longest usual step, which a packet makes long.
double gap_threshold(std::span<const double> stamps) {
  std::vector<double> steps;
  for (std::size_t k = 1; k < stamps.size(); ++k) steps.push_back(stamps[k] - stamps[k - 1]);
  return inertial::gap_over_usual_step * quantile(std::move(steps), inertial::usual_step_quantile);
}

/// Period as if no sample were lost: from stamps so far apart that jitter and packets hardly count.
double period_over_rows(std::span<const double> stamps) {
  const std::size_t apart = std::clamp<std::size_t>(stamps.size() / 8, 1, 2000);
  std::vector<double> periods;
  for (std::size_t k = apart; k < stamps.size(); ++k)
    periods.push_back((stamps[k] - stamps[k - apart]) / static_cast<double>(apart));
  return median(std::move(periods));
}

/// Period where samples may be lost: mean of the steps that are about one period long.
double period_of_steps(std::span<const double> stamps) {
  const double usual = median_period(stamps);
  double sum = 0.0, n = 0.0;
  for (std::size_t k = 1; k < stamps.size(); ++k) {
    const double step = stamps[k] - stamps[k - 1];
    if (std::abs(step - usual) > 0.45 * usual) continue;
    sum += step;
    n += 1.0;
  }
  return n > 0.0 ? sum / n : usual;
}

/// Time from `expected` to a row, as the earliest of this and the next rows says, each moved back by its periods: a row
/// that comes late does not look like a lost sample, and one that is lost later does not count yet.
double time_ahead(std::span<const double> stamps, std::size_t row, double period, double expected) {
  constexpr std::size_t ahead = 3;
  double earliest = stamps[row] - expected;
  for (std::size_t i = 1; i < std::min(ahead, stamps.size() - row); ++i)
    earliest = std::min(earliest, stamps[row + i] - static_cast<double>(i) * period - expected);
  return earliest;
}

Numbering number_rows(std::span<const double> stamps, double period, double gap, LostSamples lost) {
  constexpr double follow = 0.05;  // share of a row's deviation by which the expected time moves
  Numbering rows{{0.0}, {0}};
  double offset = stamps.front();  // of the grid: stamp − period · number
  for (std::size_t k = 1; k < stamps.size(); ++k) {
    const double expected = offset + period * rows.number.back(), step = stamps[k] - stamps[k - 1];
    const bool is_gap = step > gap;
    double steps = 1.0;
    if (lost == LostSamples::anywhere)
      steps = std::max(1.0, std::round(time_ahead(stamps, k, period, expected) / period));
    if (lost == LostSamples::in_gaps_only && is_gap) steps = std::max(1.0, std::round(step / period));
    rows.number.push_back(rows.number.back() + steps);
    rows.stretch.push_back(rows.stretch.back() + (is_gap ? 1 : 0));
    const double deviation = stamps[k] - offset - period * rows.number.back();
    offset += is_gap ? deviation : follow * deviation;
  }
  return rows;
}

struct GridLine {
  double period = 0.0;
  std::vector<double> offset;  // of each stretch: about the clock's phase a gap says nothing
};

/// Robust regression of the stamps on the numbers, the period common to all stretches.
GridLine fit_line(std::span<const double> stamps, const Numbering& rows, double period) {
  constexpr int rounds = 6;
  constexpr double huber = 1.345;  // [robust standard deviations]
  const std::size_t n = stamps.size(), stretches = rows.stretch.back() + 1;
  std::vector<double> weight(n, 1.0), left(n);
  GridLine line{period, std::vector<double>(stretches)};
  for (int round = 0; round < rounds; ++round) {
    std::vector<double> weights(stretches), mean_number(stretches), mean_stamp(stretches);
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t s = rows.stretch[k];
      weights[s] += weight[k];
      mean_number[s] += weight[k] * rows.number[k];
      mean_stamp[s] += weight[k] * (stamps[k] - stamps.front());
    }
    for (std::size_t s = 0; s < stretches; ++s) mean_number[s] /= weights[s], mean_stamp[s] /= weights[s];
    double mixed = 0.0, squares = 0.0;
    for (std::size_t k = 0; k < n; ++k) {
      const double x = rows.number[k] - mean_number[rows.stretch[k]];
      mixed += weight[k] * x * (stamps[k] - stamps.front() - mean_stamp[rows.stretch[k]]);
      squares += weight[k] * x * x;
    }
    if (squares > 0.0) line.period = mixed / squares;
    for (std::size_t s = 0; s < stretches; ++s)
      line.offset[s] = stamps.front() + mean_stamp[s] - line.period * mean_number[s];
    for (std::size_t k = 0; k < n; ++k)
      left[k] = stamps[k] - line.offset[rows.stretch[k]] - line.period * rows.number[k];
    const double limit = huber * robust_sd(left);
    for (std::size_t k = 0; k < n; ++k) weight[k] = std::abs(left[k]) > limit ? limit / std::abs(left[k]) : 1.0;
    if (limit <= 0.0) break;  // the stamps are regular
  }
  return line;
}

/// The rows of a window.
struct WindowRows {
  std::size_t first = 0, stride = 1;

  std::size_t operator[](std::size_t i) const { return first + i * stride; }
};

/// Orthonormal polynomials up to the cubic at the times of a window (modified Gram-Schmidt, twice).
using CubicBasis = std::array<std::array<double, window_rows>, cubic_terms>;

CubicBasis cubic_basis(std::span<const double> times, const WindowRows& rows) {
  CubicBasis basis{};
  const double begin = times[rows[0]], half = 0.5 * (times[rows[window_rows - 1]] - begin);
  for (std::size_t term = 0; term < cubic_terms; ++term) {
    auto& column = basis[term];
    for (std::size_t i = 0; i < window_rows; ++i)
      column[i] = std::pow((times[rows[i]] - begin) / half - 1.0, static_cast<double>(term));
    for (int pass = 0; pass < 2; ++pass)
      for (std::size_t before = 0; before < term; ++before) {
        double dot = 0.0;
        for (std::size_t i = 0; i < window_rows; ++i) dot += column[i] * basis[before][i];
        for (std::size_t i = 0; i < window_rows; ++i) column[i] -= dot * basis[before][i];
      }
    double norm = 0.0;
    for (const double value : column) norm += value * value;
    constexpr double dependent = 1e-6;  // of a column of ones: rows of one packet make the higher powers equal
    for (double& value : column) value = norm > dependent ? value / std::sqrt(norm) : 0.0;
  }
  return basis;
}

/// Residual sum of squares of a triad's rows about their cubics, and the sum of squares about their means.
struct WindowSquares {
  double left = 0.0, total = 0.0;
};

WindowSquares squares_about_cubic(const TriadColumns& triad, const WindowRows& rows, const CubicBasis& basis) {
  WindowSquares sum;
  for (const auto& column : triad.axis) {
    std::array<double, window_rows> value{};
    double mean_value = 0.0;
    for (std::size_t i = 0; i < window_rows; ++i)
      mean_value += (value[i] = double{column[rows[i]]}) / static_cast<double>(window_rows);
    for (double& v : value) v -= mean_value, sum.total += v * v;
    for (const auto& term : basis) {
      double dot = 0.0;
      for (std::size_t i = 0; i < window_rows; ++i) dot += value[i] * term[i];
      for (std::size_t i = 0; i < window_rows; ++i) value[i] -= dot * term[i];
    }
    for (const double v : value) sum.left += v * v;
  }
  return sum;
}

bool has_faults(const InsSensor& sensor, const WindowRows& rows, unsigned faults) {
  for (std::size_t i = 0; i < window_rows; ++i)
    if (sensor.faults[rows[i]] & faults) return true;
  return false;
}

/// The grid that a first guess of the period leads to; empty if its times are not in the order of the rows.
std::optional<SamplingGrid> grid_from(std::span<const double> stamps, double period, double gap, LostSamples lost) {
  Numbering rows;
  GridLine line;
  for (int round = 0; round < 2; ++round) {
    rows = number_rows(stamps, period, gap, lost);
    line = fit_line(stamps, rows, period);
    period = line.period;
  }
  SamplingGrid grid{period, {}};
  for (std::size_t k = 0; k < stamps.size(); ++k) {
    grid.time.push_back(line.offset[rows.stretch[k]] + period * rows.number[k]);
    if (k > 0 && !(grid.time[k] - grid.time[k - 1] > 0.5 * period)) return std::nullopt;
  }
  return grid;
}

}  // namespace

std::optional<SamplingGrid> fit_sampling_grid(std::span<const double> stamps, LostSamples lost) {
  if (stamps.size() < inertial::min_grid_rows) return std::nullopt;
  const double gap = gap_threshold(stamps), over_rows = period_over_rows(stamps);
  if (lost == LostSamples::in_gaps_only) return grid_from(stamps, over_rows, gap, lost);
  auto best = grid_from(stamps, over_rows, gap, lost), other = grid_from(stamps, period_of_steps(stamps), gap, lost);
  if (!best || (other && time_scatter(stamps, other->time) < time_scatter(stamps, best->time))) best = std::move(other);
  return best;
}

double time_scatter(std::span<const double> stamps, std::span<const double> times) {
  std::vector<double> difference;
  for (std::size_t k = 0; k < stamps.size(); ++k) difference.push_back(stamps[k] - times[k]);
  return standard_deviation(difference);
}

bool TimeEvidence::favours_other() const {
  return gain > inertial::min_time_gain && gain > inertial::min_time_gain_sd * std::sqrt(variance);
}

std::size_t window_stride(double scatter, double period) {
  return std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(std::sqrt(3.0) * scatter / period - 0.5)));
}

TimeEvidence compare_times(const InsSensor& sensor, std::span<const double> stamps, std::span<const double> other,
                           std::size_t stride) {
  constexpr double freedom = 3.0 * static_cast<double>(window_rows - cubic_terms), rounding = 1e-10;
  const std::size_t length = window_rows * stride, windows = stamps.size() / length,
                    every = std::max<std::size_t>(1, windows / most_grid_windows);
  TimeEvidence sum;
  std::vector<double> gains;
  for (std::size_t w = 0; w < windows; w += every) {
    const WindowRows rows{w * length, stride};
    const CubicBasis at_stamps = cubic_basis(stamps, rows), at_other = cubic_basis(other, rows);
    const auto add = [&](const TriadColumns& triad, unsigned faults) {
      if (has_faults(sensor, rows, faults)) return;
      const WindowSquares by_stamps = squares_about_cubic(triad, rows, at_stamps),
                          by_other = squares_about_cubic(triad, rows, at_other);
      const double floor = rounding * by_stamps.total;
      if (!(floor > 0.0)) return;  // constant
      gains.push_back(0.5 * freedom * std::log((by_stamps.left + floor) / (by_other.left + floor)));
    };
    add(sensor.angular_velocity, angular_velocity_missing | angular_velocity_clipped | angular_velocity_spike);
    add(sensor.acceleration, acceleration_missing | acceleration_clipped | acceleration_spike);
  }
  for (const double gain : gains) sum.gain += gain;
  const double sd = standard_deviation(gains);
  sum.variance = sd * sd * static_cast<double>(gains.size());
  return sum;
}

}  // namespace kinfer
