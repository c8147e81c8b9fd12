// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/model/bias_process.hpp"

#include <algorithm>
#include <cmath>

namespace kinfer {
namespace {

using Index = Eigen::Index;

constexpr double perfect_rate = 1e-9, perfect_force = 1e-8;  // [rad/s], [m/s²] if only the other bias varies

constexpr Index long_recording = 12288;  // intervals, twenty minutes: from here on segments of double length pay off

Index segment_intervals(const SplineGrid& grid) {
  return grid.intervals < long_recording ? 64 : 128;
}

Index count_of(const SplineGrid& grid) {
  return std::max<Index>(1, grid.intervals / segment_intervals(grid));
}

}  // namespace

std::vector<TimeSegment> time_segments_of(const SplineGrid& grid) {
  std::vector<TimeSegment> time_segments;
  const Index count = count_of(grid), length = segment_intervals(grid);
  for (Index k = 0; k < count; ++k)
    time_segments.push_back({k * length, k + 1 == count ? grid.intervals : (k + 1) * length});
  return time_segments;
}

Index time_segment_at(const SplineGrid& grid, Index interval) {
  return std::min(interval / segment_intervals(grid), count_of(grid) - 1);
}

InsErrors errors_at(const InsProblem& problem, const InsUnknowns& x, std::size_t sensor, Index interval) {
  InsErrors errors = x.errors[sensor];
  if (x.bias_process.size() == 0) return errors;
  const auto now =
      x.bias_process.col(time_segment_at(problem.grid, interval)).segment<6>(6 * static_cast<Index>(sensor));
  errors.gyroscope_bias += now.head<3>();
  errors.accelerometer_bias += now.tail<3>();
  return errors;
}

BiasProcessPrior bias_process_prior(const InsProblem& problem, const InsLayout& layout) {
  const BiasProcess& bias_process = problem.bias_process;
  BiasProcessPrior prior{.decay = std::exp(-problem.grid.period * static_cast<double>(segment_intervals(problem.grid)) /
                                           bias_process.time),
                         .information = VectorXd(layout.bias_process),
                         .innovation = {}};
  for (Index at = 0; at < layout.bias_process; at += 3) {
    const double sd =
        at % 6 == 0 ? std::max(bias_process.rate_sd, perfect_rate) : std::max(bias_process.force_sd, perfect_force);
    prior.information.segment<3>(at).setConstant(1.0 / (sd * sd));
  }
  prior.innovation = prior.information / (1.0 - prior.decay * prior.decay);
  return prior;
}

std::vector<Index> bias_parameters(const InsLayout& layout) {
  std::vector<Index> border;
  for (const Index first : layout.error)
    for (Index i = 0; i < 6 && layout.bias_process > 0; ++i) border.push_back(first + i);
  return border;
}

double bias_process_cost(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x) {
  if (layout.bias_process == 0) return 0.0;
  const BiasProcessPrior prior = bias_process_prior(problem, layout);
  double cost = x.bias_process.col(0).cwiseAbs2().dot(prior.information);
  for (Index k = 1; k < x.bias_process.cols(); ++k)
    cost += (x.bias_process.col(k) - prior.decay * x.bias_process.col(k - 1)).cwiseAbs2().dot(prior.innovation);
  return cost;
}

}  // namespace kinfer
