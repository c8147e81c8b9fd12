// SPDX-License-Identifier: Apache-2.0
#include "kinfer/inertial/clipped_peaks.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/expect.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/measurement/ins/clipping.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;

constexpr double shoulder_share = 0.5;                              // of the peak's length, on each side
constexpr double shortest_shoulder = 0.06, longest_shoulder = 0.6;  // [s]
constexpr Index highest_degree = 6;
constexpr std::size_t samples_per_coefficient = 2;
constexpr double highest_excess = 2.0;  // of that of the parabola through the shoulders' slopes

/// One axis of an instrument: its values, and which of them are clipped or missing.
struct ClippedAxis {
  std::vector<float>& values;
  std::span<const double> time;
  const std::vector<std::int8_t>& side;  // 0: measured
  const std::vector<bool>& is_missing;

  bool is_sound(std::size_t row) const { return side[row] == 0 && !is_missing[row]; }

  /// Sound rows within `reach` of the peak [first, last], on one side.
  std::vector<std::size_t> shoulder(std::size_t from, int step, double reach) const {
    std::vector<std::size_t> rows;
    const double start = time[from];
    for (auto row = static_cast<std::ptrdiff_t>(from) + step; row >= 0 && row < std::ssize(values); row += step) {
      const auto at = static_cast<std::size_t>(row);
      if (std::abs(time[at] - start) > reach) break;
      if (is_sound(at)) rows.push_back(at);
    }
    return rows;
  }

  /// [per second] of the values, by least squares over a few rows.
  double slope(std::vector<std::size_t> rows) const {
    if (rows.size() > 6) rows.resize(6);
    double t = 0.0, v = 0.0, tt = 0.0, tv = 0.0;
    const auto n = static_cast<double>(rows.size());
    for (const std::size_t row : rows) t += time[row] / n, v += double{values[row]} / n;
    for (const std::size_t row : rows) {
      tt += (time[row] - t) * (time[row] - t);
      tv += (time[row] - t) * (double{values[row]} - v);
    }
    return tt > 0.0 ? tv / tt : 0.0;
  }

  /// Polynomial through both shoulders at the rows of the peak.
  void restore(std::size_t first, std::size_t last) const {
    const double length = time[last] - time[first],
                 reach = std::clamp(shoulder_share * length, shortest_shoulder, longest_shoulder);
    const auto before = shoulder(first, -1, reach), after = shoulder(last, 1, reach);
    if (before.size() < samples_per_coefficient || after.size() < samples_per_coefficient) return;
    const std::size_t count = before.size() + after.size();
    const Index degree = std::min(highest_degree, static_cast<Index>(count / samples_per_coefficient) - 1);
    const double middle = 0.5 * (time[first] + time[last]), scale = 0.5 * length + reach;
    const auto powers = [&](std::size_t row) {
      VectorXd p(degree + 1);
      p[0] = 1.0;
      for (Index i = 1; i <= degree; ++i) p[i] = p[i - 1] * (time[row] - middle) / scale;
      return p;
    };
    MatrixXd matrix(static_cast<Index>(count), degree + 1);
    VectorXd right(static_cast<Index>(count));
    Index at = 0;
    for (const auto* rows : {&before, &after})
      for (const std::size_t row : *rows) {
        matrix.row(at) = powers(row).transpose();
        right[at++] = double{values[row]};
      }
    const VectorXd polynomial = solve_least_squares(matrix, right);
    const double sign = side[first], limit = sign * double{values[first]};
    const double rise = std::max(0.0, sign * slope(before)), fall = std::max(0.0, -sign * slope(after));
    const double highest = limit + highest_excess * 0.125 * (rise + fall) * length;
    for (std::size_t row = first; row <= last; ++row)
      if (side[row] != 0)
        values[row] = static_cast<float>(sign * std::clamp(sign * polynomial.dot(powers(row)), limit, highest));
  }
};

/// Restores all peaks of an instrument.
void restore_peaks(const InsSensor& sensor, std::span<const double> time, TriadColumns& triad, Fault clipped,
                   unsigned unusable) {
  const double range = clipping_range(sensor, triad, clipped);
  if (!(range > 0.0)) return;
  std::vector<bool> is_missing(sensor.rows());
  std::array<std::vector<std::int8_t>, 3> sides;
  for (auto& side : sides) side.resize(sensor.rows());
  for (std::size_t row = 0; row < sensor.rows(); ++row) {
    is_missing[row] = (sensor.faults[row] & unusable) != 0;
    const ClippedSides own = clipped_sides(sensor, triad, clipped, range, row);
    for (std::size_t k = 0; k < 3; ++k) sides[k][row] = own[k];
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const ClippedAxis axis{triad.axis[k], time, sides[k], is_missing};
    for (std::size_t first = 0; first < sensor.rows(); ++first) {
      if (sides[k][first] == 0) continue;
      std::size_t last = first;
      for (std::size_t row = first; row < sensor.rows() && (sides[k][row] == sides[k][first] || is_missing[row]); ++row)
        if (sides[k][row] == sides[k][first]) last = row;
      axis.restore(first, last);
      first = last;
    }
  }
}

void clear(std::vector<std::uint8_t>& faults, unsigned fault) {
  for (std::uint8_t& bits : faults) bits = static_cast<std::uint8_t>(bits & ~fault);
}

}  // namespace

InsSensor restore_clipped_peaks(const InsSensor& sensor, std::span<const double> time) {
  KINFER_EXPECT(time.size() == sensor.rows());
  InsSensor restored = sensor;
  if (count(sensor, angular_velocity_clipped) > 0) {
    restore_peaks(sensor, time, restored.angular_velocity, angular_velocity_clipped,
                  angular_velocity_missing | angular_velocity_spike);
    clear(restored.faults, angular_velocity_clipped);
  }
  if (count(sensor, acceleration_clipped) > 0) {
    restore_peaks(sensor, time, restored.acceleration, acceleration_clipped, acceleration_missing | acceleration_spike);
    clear(restored.faults, acceleration_clipped);
  }
  return restored;
}

}  // namespace kinfer
