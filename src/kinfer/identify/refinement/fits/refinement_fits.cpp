// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/refinement/fits/refinement_fits.hpp"

#include <algorithm>
#include <cmath>

namespace kinfer::identify {
namespace {

using Index = Eigen::Index;

constexpr double finest_knot_spacing = 0.025;  // [s] knot spacing
constexpr int low_frequency_iterations = 8;

MatrixXd resample_spline(const SplineGrid& to, const SplineGrid& from, ConstMatrixRef coefficients) {
  const double step = 0.5 * std::min(to.period, from.period);
  const auto count = static_cast<std::size_t>((from.end() - from.begin) / step);
  std::vector<double> time;
  MatrixXd values(static_cast<Index>(count) + 1, coefficients.rows());
  for (std::size_t i = 0; i <= count; ++i) {
    time.push_back(from.begin + step * static_cast<double>(i));
    values.row(static_cast<Index>(i)) = spline_value(from, coefficients, time.back()).transpose();
  }
  return fit_spline(to, time, values);
}

/// The step in a body's unknowns from one estimate of it to another.
VectorXd shift_of(const InsBody& from, const InsBody& to) {
  VectorXd shift(from.unknowns());
  Index k = 0;
  const auto turn = [&](const Mat3& a, const Mat3& b, const std::array<bool, 3>& is_free) {
    const Vec3 v = log_so3(a.transpose() * b);
    for (std::size_t i = 0; i < 3; ++i)
      if (is_free[i]) shift[k++] = v[static_cast<Index>(i)];
  };
  turn(from.parent_R_axis, to.parent_R_axis, from.free_parent_rotation);
  turn(from.child_R_axis, to.child_R_axis, from.free_child_rotation);
  if (from.free_point_in_parent) shift.segment<3>(k) = to.point_in_parent - from.point_in_parent, k += 3;
  if (from.free_point_in_child) shift.segment<3>(k) = to.point_in_child - from.point_in_child;
  return shift;
}

}  // namespace

void anchor(RefinementSetup& setup) {
  setup.problem.anchor.clear();
  for (Index k = setup.problem.root_at_rest ? 0 : 6; k < setup.start.spline_coefficients.rows(); ++k)
    setup.problem.anchor.push_back(setup.start.spline_coefficients(k, 0));
}

void report_progress(const Observer& observer, const char* stage, double fraction) {
  notify(observer, {.stage = stage, .fraction = fraction, .best = 0.0, .median = 0.0, .iteration = 0, .detail = {}});
}

RefinementSetup continue_from(const RefinementTask& task, const InsRecording& recording, double knot_spacing,
                              const InsProblem& problem, const InsUnknowns& found) {
  RefinementSetup setup = set_up_refinement(recording, task.motion, task.tree, task.starts, task.grade, knot_spacing,
                                            task.least_noise, task.common);
  setup.problem.facts = task.facts;
  setup.problem.scale_factors = problem.scale_factors;
  setup.start = found;
  for (InsErrors& errors : setup.start.errors) errors.clock = {};  // small enough to be neglected here
  setup.start.spline_coefficients = resample_spline(setup.problem.grid, problem.grid, found.spline_coefficients);
  anchor(setup);
  return setup;
}

InsFit fit_motion_only(const RefinementTask& task, RefinementSetup& setup) {
  InsFitOptions motion_only = task.options;
  motion_only.reweighting_rounds = 0;
  return fit_ins(setup.problem, setup.start, motion_only);
}

RefinementFit fit_whole_motion(const RefinementTask& task, const RefinementFit& found) {
  RefinementFit full_bandwidth{
      continue_from(task, task.recording, finest_knot_spacing, found.setup.problem, found.fit.unknowns), {}};
  full_bandwidth.fit = fit_motion_only(task, full_bandwidth.setup);
  return full_bandwidth;
}

RefinementFit fit_from(const RefinementTask& task, RefinementSetup setup) {
  InsFitOptions options = task.options;
  options.iterations = low_frequency_iterations;
  RefinementFit result{std::move(setup), {}};
  result.fit = fit_ins(result.setup.problem, result.setup.start, options);
  return result;
}

double worst_misfit(const InsProblem& problem) {
  double worst = 1.0;
  for (const InsMeasurements& r : problem.sensors)
    worst = std::max(
        {worst, r.noise.angular_velocity / r.noise_floor.angular_velocity, r.noise.force / r.noise_floor.force});
  return worst;
}

double log_residual(const RefinementFit& fitted) {
  double sum = 0.0;
  const auto add = [&](double noise, const InstrumentFit& fit) {
    if (fit.terms > 0.0) sum += std::log(noise * std::sqrt(fit.squares / fit.terms));
  };
  for (std::size_t s = 0; s < fitted.setup.problem.sensors.size(); ++s) {
    const InsNoise& noise = fitted.setup.problem.sensors[s].noise;
    add(noise.angular_velocity, fitted.fit.cost.sensors[s].angular_velocity);
    add(noise.force, fitted.fit.cost.sensors[s].force);
  }
  return sum;
}

std::vector<MatrixXd> shifts(const InsBodies& from, const InsBodies& to) {
  std::vector<MatrixXd> result;
  for (std::size_t b = 0; b < from.size(); ++b) result.push_back(shift_of(from[b], to[b]));
  return result;
}

}  // namespace kinfer::identify
