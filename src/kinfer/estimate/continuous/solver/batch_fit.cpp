// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/solver/batch_fit.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "kinfer/estimate/continuous/model/retraction.hpp"
#include "kinfer/estimate/continuous/solver/noise_update.hpp"
#include "kinfer/estimate/continuous/solver/normal_equations.hpp"

namespace kinfer {
namespace {

constexpr double first_damping = 1e-3, most_damping = 1e8;
constexpr double least_damping = 1e-14;  // must not freeze a weakly observable azimuth
constexpr double rough_decrease = 1.0;   // of the cost: enough while the weights still change
constexpr double tolerated_rise = 1.2;   // factor of the cost
constexpr int non_monotone_limit = 4;
constexpr int round_iterations = 4;       // before the instruments are reweighted
constexpr double linear_fraction = 0.01;  // fraction of a step over which the cost is linear

struct LevenbergMarquardt {
  InsProblem& problem;
  const InsFitOptions& options;
  InsFit fit;
  double damping = first_damping;

  struct Point {
    InsUnknowns unknowns;
    InsCost cost;
  };

  /// Step of the damped normal equations at `from`; empty if they are not positive definite.
  std::optional<InsStep> direction(const InsUnknowns& from, bool hold_global_parameters) const {
    return InsSystem(problem, fit.layout, from, {damping, damping, hold_global_parameters}, options.threads).solve();
  }

  Point evaluate_step(const InsUnknowns& from, const InsStep& step) const {
    InsUnknowns to = retract(problem, fit.layout, from, step);
    InsCost cost = cost_of(problem, fit.layout, to, options.threads);
    return {std::move(to), std::move(cost)};
  }

  Point partial_step(const InsStep& step, double share) const {
    return evaluate_step(fit.unknowns,
                         {share * step.spline_coefficients, share * step.border, share * step.bias_process});
  }

  void accept(Point&& point) {
    fit.unknowns = std::move(point.unknowns);
    fit.cost = std::move(point.cost);
  }

  /// Non-monotone step: a slight increase of the cost is tolerated for a few further steps. In a curved valley a long
  /// step climbs the wall and the next one returns to the floor, where monotone steps would be very short.
  Point non_monotone_steps(Point trial, bool hold_global_parameters) const {
    for (int look = 0; look < non_monotone_limit && trial.cost.total >= fit.cost.total &&
                       trial.cost.total < tolerated_rise * fit.cost.total;
         ++look) {
      const auto next = direction(trial.unknowns, hold_global_parameters);
      if (!next) break;
      trial = evaluate_step(trial.unknowns, *next);
    }
    return trial;
  }

  /// One accepted step; false at a minimum or if no damping decreases the cost.
  bool step(bool hold_global_parameters) {
    for (; damping < most_damping; damping *= 10.0) {
      const auto first = direction(fit.unknowns, hold_global_parameters);
      if (!first) continue;
      Point trial = evaluate_step(fit.unknowns, *first);
      if (trial.cost.total < fit.cost.total) {
        accept(std::move(trial));
        damping = std::max(least_damping, 0.03 * damping);
        return true;
      }
      const double rise = trial.cost.total - fit.cost.total,
                   slope = (fit.cost.total - partial_step(*first, linear_fraction).cost.total) / linear_fraction;
      if (slope < options.least_decrease) break;  // a minimum: a more damped step would gain even less
      // Robust weights that change along the step make it too long: take the minimum of the interpolating parabola.
      trial = rise < slope ? partial_step(*first, 0.5 * slope / (slope + rise))
                           : non_monotone_steps(std::move(trial), hold_global_parameters);
      if (trial.cost.total >= fit.cost.total) continue;
      accept(std::move(trial));
      return true;
    }
    damping = first_damping;
    return false;
  }

  /// Reweights the instruments and recomputes the cost; true if a noise level changed notably.
  bool reweight() {
    const bool changed = update_noise(problem, fit.cost);
    fit.cost = cost_of(problem, fit.layout, fit.unknowns, options.threads);
    return changed;
  }

  /// Iterates until the cost decreases by less than `least_decrease`, the round or the budget ends, or the residuals
  /// have become so much smaller that the instruments need reweighting.
  Stop round(int iterations, double least_decrease, const Observer& observer) {
    for (int i = 0; i < iterations && fit.iterations < options.iterations; ++i, ++fit.iterations) {
      if (i >= round_iterations && needs_reweighting(problem, fit.cost)) return Stop::budget_spent;
      const double before = fit.cost.total;
      if (!step(false)) return Stop::stalled;
      const Progress progress{.stage = "estimate",
                              .fraction = static_cast<double>(fit.iterations) / options.iterations,
                              .best = fit.cost.total,
                              .median = 0.0,
                              .iteration = fit.iterations,
                              .detail = {}};
      if (notify(observer, progress) == ObserverDecision::stop) return Stop::cancelled;
      if (before - fit.cost.total < least_decrease && damping < first_damping) return Stop::converged_cost;
    }
    return Stop::budget_spent;
  }
};

}  // namespace

InsFit fit_ins(InsProblem& problem, const InsUnknowns& start, const InsFitOptions& options, const Observer& observer) {
  LevenbergMarquardt m{problem, options, {start, layout_of(problem, start.bodies), {}}};
  InsFit& fit = m.fit;
  const auto time_segments = static_cast<Eigen::Index>(time_segments_of(problem.grid).size());
  if (fit.unknowns.bias_process.rows() != fit.layout.bias_process || fit.unknowns.bias_process.cols() != time_segments)
    fit.unknowns.bias_process = MatrixXd::Zero(fit.layout.bias_process, time_segments);
  fit.cost = cost_of(problem, fit.layout, fit.unknowns, options.threads);
  for (int i = 0; i < options.trajectory_iterations; ++i, ++fit.iterations) {
    m.reweight();
    m.step(true);
  }
  bool changed = m.reweight();
  for (int round = 0; round < options.reweighting_rounds; ++round) {
    const bool preliminary = changed;
    fit.stop = preliminary ? m.round(round_iterations, rough_decrease, observer)
                           : m.round(options.iterations, options.least_decrease, observer);
    if (fit.stop == Stop::cancelled || fit.iterations >= options.iterations) break;
    const bool done = fit.stop != Stop::budget_spent;
    changed = m.reweight();
    if (done && !changed && !preliminary) break;
  }
  return fit;
}

}  // namespace kinfer
