// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/excerpt.hpp"

#include <algorithm>
#include <cmath>

namespace kinfer {
namespace {

using Index = Eigen::Index;

constexpr Index excerpt_windows = 48;    // times excerpt_window intervals: five minutes
constexpr Index least_length_ratio = 4;  // a recording this many times as long as the excerpt uses one
constexpr Index gap_intervals =
    spline_order;                        // intervals without measurements at a window's end, so that splines may jump
constexpr double base_excitation = 0.1;  // [rad²/s²] sum of squared differences of angular speed: hardly any rotation

/// Norm of the mean angular velocity of a block; 0 without measurements.
double mean_rate(const InsBlock& block) {
  const auto by_offset = block.factor.rowwise().sum().eval();
  const float square = by_offset.squaredNorm();
  return square > 0.0F ? double{(block.target.transpose() * by_offset).norm() / square} : 0.0;
}

/// The sensor on the nearest ancestor body that has one; −1: none.
int sensor_before(const InsBodies& bodies, std::size_t body) {
  int at = bodies[body].parent;
  while (at >= 0 && bodies[static_cast<std::size_t>(at)].sensor < 0) at = bodies[static_cast<std::size_t>(at)].parent;
  return at < 0 ? -1 : bodies[static_cast<std::size_t>(at)].sensor;
}

/// Rotational excitation of each joint (row) in each window (column).
MatrixXd rotational_excitation(const InsProblem& problem, const InsBodies& bodies) {
  const Index windows = problem.grid.intervals / excerpt_window;
  MatrixXd excitation = MatrixXd::Zero(static_cast<Index>(bodies.size()), windows);
  for (std::size_t b = 1; b < bodies.size(); ++b) {
    const int before = sensor_before(bodies, b), own = bodies[b].sensor;
    if (before < 0 || own < 0) continue;
    const auto &x = problem.sensors[static_cast<std::size_t>(before)].angular_velocity,
               &y = problem.sensors[static_cast<std::size_t>(own)].angular_velocity;
    for (Index i = 0; i < windows * excerpt_window; ++i) {
      const auto at = static_cast<std::size_t>(i);
      excitation(static_cast<Index>(b), i / excerpt_window) += std::pow(mean_rate(y[at]) - mean_rate(x[at]), 2);
    }
  }
  return excitation;
}

/// Appends a window's blocks, the last intervals without measurements.
void copy_blocks(const std::vector<InsBlock>& from, Index window, std::vector<InsBlock>& to) {
  if (from.empty()) return;
  const auto first = from.begin() + window * excerpt_window;
  to.insert(to.end(), first, first + (excerpt_window - gap_intervals));
  to.insert(to.end(), static_cast<std::size_t>(gap_intervals), InsBlock{});
}

void copy_blocks(const InsClippedBlocks& from, Index window, InsClippedBlocks& to) {
  if (from.empty()) return;
  copy_blocks(from.blocks, window, to.blocks);
  const auto first = from.sides.begin() + window * excerpt_window;
  to.sides.insert(to.sides.end(), first, first + excerpt_window);
}

}  // namespace

std::vector<Index> most_informative_windows(const InsProblem& problem, const InsBodies& bodies, Index count) {
  const MatrixXd excitation = rotational_excitation(problem, bodies);
  std::vector<bool> taken(static_cast<std::size_t>(excitation.cols()), false);
  VectorXd sum = VectorXd::Constant(excitation.rows(), base_excitation);
  std::vector<Index> chosen;
  while (static_cast<Index>(chosen.size()) < std::min(count, excitation.cols())) {
    Index best = -1;
    double most = -1.0;
    for (Index k = 0; k < excitation.cols(); ++k) {
      if (taken[static_cast<std::size_t>(k)]) continue;
      const double gain = (excitation.col(k).array() / sum.array()).log1p().sum();
      if (gain > most) best = k, most = gain;
    }
    taken[static_cast<std::size_t>(best)] = true;
    sum += excitation.col(best);
    chosen.push_back(best);
  }
  std::ranges::sort(chosen);
  return chosen;
}

InsExcerpt excerpt_of(const InsProblem& problem, const InsUnknowns& start, const std::vector<Index>& windows) {
  const auto count = static_cast<Index>(windows.size());
  InsExcerpt excerpt{.problem = {.grid = {0.0, problem.grid.period, count * excerpt_window},
                                 .root_at_rest = problem.root_at_rest,
                                 .sensors = {},
                                 .prior = problem.prior,
                                 .common = problem.common,
                                 .bias_process = problem.bias_process,
                                 .gravity = problem.gravity,
                                 .gravity_sd = problem.gravity_sd,
                                 .point_sd = problem.point_sd,
                                 .rotation_sd = problem.rotation_sd,
                                 .anchor = {}},
                     .start = start};
  // Biases decorrelate as much between the excerpt's windows as they do in the recording.
  excerpt.problem.bias_process.time *=
      static_cast<double>(count * excerpt_window) / static_cast<double>(problem.grid.intervals);
  excerpt.problem.prior.clock_offset = excerpt.problem.prior.clock_drift = 0.0;
  for (const InsMeasurements& from : problem.sensors) {
    InsMeasurements to{.angular_velocity = {}, .force = {}, .noise = from.noise, .noise_floor = from.noise_floor};
    for (const Index k : windows) {
      copy_blocks(from.angular_velocity, k, to.angular_velocity);
      copy_blocks(from.force, k, to.force);
      copy_blocks(from.clipped_rate, k, to.clipped_rate);
      copy_blocks(from.clipped_force, k, to.clipped_force);
    }
    excerpt.problem.sensors.push_back(std::move(to));
  }
  excerpt.start.facts = {};
  for (InsErrors& errors : excerpt.start.errors) errors.clock = {};
  excerpt.start.spline_coefficients.resize(start.spline_coefficients.rows(), excerpt.problem.grid.coefficients());
  for (Index i = 0; i < count; ++i) {
    const Index width = excerpt_window + (i + 1 == count ? spline_order - 1 : 0);
    excerpt.start.spline_coefficients.middleCols(i * excerpt_window, width) =
        start.spline_coefficients.middleCols(windows[static_cast<std::size_t>(i)] * excerpt_window, width);
  }
  for (Index joint = problem.root_at_rest ? 0 : 6; joint < start.spline_coefficients.rows(); ++joint)
    excerpt.problem.anchor.push_back(excerpt.start.spline_coefficients(joint, 0));
  return excerpt;
}

bool start_from_excerpt(InsProblem& problem, InsUnknowns& start, const InsFitOptions& options,
                        const Observer& observer) {
  if (problem.grid.intervals < least_length_ratio * excerpt_windows * excerpt_window) return false;
  InsExcerpt excerpt = excerpt_of(problem, start, most_informative_windows(problem, start.bodies, excerpt_windows));
  const InsFit fit = fit_ins(excerpt.problem, excerpt.start, options, observer);
  start.bodies = fit.unknowns.bodies;
  start.root_force = fit.unknowns.root_force;
  for (std::size_t s = 0; s < start.errors.size(); ++s) {
    const InsClock clock = start.errors[s].clock;
    start.errors[s] = fit.unknowns.errors[s];
    start.errors[s].clock = clock;
    problem.sensors[s].noise = excerpt.problem.sensors[s].noise;
  }
  return true;
}

}  // namespace kinfer
