// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/fast_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinfer/base/square.hpp"
#include "kinfer/estimate/continuous/knot_spacing.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;

constexpr double wider = std::numbers::sqrt2;
constexpr double certainty = 4.0;    // standard deviations of the variance of white noise
constexpr double by_chance = 0.005;  // share of the intervals; of white noise 0.001 to 0.002 are beyond
constexpr double usual = 0.75;       // share of the intervals that tells whether splines follow the motion at all
// Three quarters of the intervals keep within this many variances of noise: at most 32 on machines that start their
// joints within 0.4 s, 47 on a robot arm (UR5), 2 on another (iiwa); 1700 and more on a chain in hands (DIODEM), where
// a fit of the low frequencies is what tells.
constexpr double most_usual_variance = 200.0;

/// Sums over the samples of each interval: squares of what splines leave, and how many there are.
struct SplineResiduals {
  std::array<std::vector<double>, 2> squares;  // gyroscope, accelerometer
  std::vector<double> terms;
  double freedom = 1.0;  // share of the samples that the splines do not follow by themselves

  explicit SplineResiduals(std::size_t intervals)
      : squares{std::vector<double>(intervals), std::vector<double>(intervals)}, terms(intervals) {}
};

SplineResiduals spline_residuals(const InsSensor& sensor, std::span<const double> time, const SplineGrid& grid) {
  const SplineGrid wide{grid.begin, wider * grid.period,
                        static_cast<Index>(std::ceil(static_cast<double>(grid.intervals) / wider))};
  const MatrixXd rows = measurement_rows(sensor, time, 0, time.size()), spline = fit_spline(wide, time, rows);
  SplineResiduals sums(static_cast<std::size_t>(grid.intervals));
  double used = 0.0;
  for (std::size_t i = 0; i < time.size(); ++i) {
    const auto row = rows.row(static_cast<Index>(i));
    const double where = std::floor((time[i] - grid.begin) / grid.period);
    if (!row.allFinite() || where < 0.0 || where >= static_cast<double>(grid.intervals)) continue;
    const VectorXd left = row.transpose() - spline_value(wide, spline, time[i]);
    const auto interval = static_cast<std::size_t>(where);
    sums.squares[0][interval] += left.head<3>().squaredNorm();
    sums.squares[1][interval] += left.tail<3>().squaredNorm();
    sums.terms[interval] += 3.0;
    used += 1.0;
  }
  sums.freedom = used > 0.0 ? 1.0 - static_cast<double>(wide.coefficients()) / used : 0.0;
  return sums;
}

/// Over those of noise; 0 without measurements.
std::vector<double> variances(const std::vector<double>& squares, const SplineResiduals& sums, double noise) {
  std::vector<double> result(squares.size());
  for (std::size_t k = 0; k < squares.size(); ++k)
    if (sums.terms[k] > 0.0) result[k] = squares[k] / (sums.terms[k] * sums.freedom * square(noise));
  return result;
}

bool follow_usually(std::vector<double> variances) {
  std::erase(variances, 0.0);
  if (variances.empty()) return false;
  const auto at = variances.begin() + static_cast<std::ptrdiff_t>(usual * static_cast<double>(variances.size() - 1));
  std::ranges::nth_element(variances, at);
  return *at < most_usual_variance;
}

/// Means over an interval and its neighbours, as far as they are more than chance: splines ring about a jerk.
std::vector<double> beyond_chance(const std::vector<double>& variances, const SplineResiduals& sums) {
  std::vector<double> result(variances.size(), 1.0);
  for (std::size_t k = 0; k < variances.size(); ++k) {
    double sum = 0.0, terms = 0.0;
    for (std::size_t i = k > 0 ? k - 1 : 0; i < std::min(k + 2, variances.size()); ++i)
      sum += sums.terms[i] * variances[i], terms += sums.terms[i];
    if (terms > 0.0 && sum > terms * (1.0 + certainty * std::sqrt(2.0 / (terms * sums.freedom))))
      result[k] = sum / terms;
  }
  const auto raised = std::ranges::count_if(result, [](double variance) { return variance > 1.0; });
  if (static_cast<double>(raised) < by_chance * static_cast<double>(result.size())) std::ranges::fill(result, 1.0);
  return result;
}

void set_excess(InsBlock& block, float excess) {
  const float factor = std::sqrt(block.excess / excess);
  block.factor *= factor;
  block.target *= factor;
  block.left *= factor * factor;
  block.excess = excess;
}

void discount(std::vector<InsBlock>& blocks, const std::vector<double>& excess) {
  for (std::size_t k = 0; k < blocks.size(); ++k) set_excess(blocks[k], static_cast<float>(excess[k]));
}

}  // namespace

std::array<std::vector<double>, 2> unfollowed_variances(const InsSensor& sensor, std::span<const double> time,
                                                        const SplineGrid& grid, const InsNoise& noise) {
  const std::vector<double> none(static_cast<std::size_t>(grid.intervals), 1.0);
  const SplineResiduals sums = spline_residuals(sensor, time, grid);
  if (sums.freedom <= 0.0) return {none, none};
  const auto of_instrument = [&](const std::vector<double>& squares, double sd) {
    const std::vector<double> all = variances(squares, sums, sd);
    return follow_usually(all) ? beyond_chance(all, sums) : none;
  };
  return {of_instrument(sums.squares[0], noise.angular_velocity), of_instrument(sums.squares[1], noise.force)};
}

void discount_fast_motion(InsMeasurements& measured, const InsSensor& sensor, std::span<const double> time,
                          const SplineGrid& grid) {
  const auto excess = unfollowed_variances(sensor, time, grid, measured.noise);
  discount(measured.angular_velocity, excess[0]);
  discount(measured.force, excess[1]);
}

bool discounts_fast_motion(const InsProblem& problem) {
  const auto is_discounted = [](const InsBlock& block) { return block.excess > 1.0F; };
  return std::ranges::any_of(problem.sensors, [&](const InsMeasurements& sensor) {
    return std::ranges::any_of(sensor.angular_velocity, is_discounted) ||
           std::ranges::any_of(sensor.force, is_discounted);
  });
}

void count_fast_motion(InsProblem& problem) {
  for (InsMeasurements& sensor : problem.sensors)
    for (auto* blocks : {&sensor.angular_velocity, &sensor.force})
      for (InsBlock& block : *blocks) set_excess(block, 1.0F);
}

}  // namespace kinfer
