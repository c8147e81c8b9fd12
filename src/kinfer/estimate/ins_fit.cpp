#include "kinfer/estimate/ins_fit.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "kinfer/estimate/ins_noise.hpp"
#include "kinfer/estimate/ins_system.hpp"

namespace kinfer {
namespace {

constexpr double first_damping = 1e-3, most_damping = 1e8;
constexpr double least_damping = 1e-14;  // must not hold a weakly known azimuth
constexpr double rough_decrease = 1.0;   // of the cost, that is worth a step while the weights still change
constexpr double little_uphill = 1.2;    // times the cost
constexpr int most_looks = 4;
constexpr int round_iterations = 4;  // before the instruments are weighed anew
constexpr double short_way = 0.01;   // of a step, over which the cost is straight

struct Marquardt {
  InsProblem& problem;
  const InsFitOptions& options;
  InsFit fit;
  double damping = first_damping;

  struct Point {
    InsUnknowns unknowns;
    InsCost cost;
  };

  /// Where the damped equations at `from` lead; nothing where they are not positive definite.
  std::optional<InsStep> direction(const InsUnknowns& from, bool hold_border) const {
    return InsSystem(problem, fit.layout, from, {damping, damping, hold_border}, options.threads).solve();
  }

  Point reached(const InsUnknowns& from, const InsStep& step) const {
    InsUnknowns to = changed(problem, fit.layout, from, step);
    InsCost cost = cost_of(problem, fit.layout, to, options.threads);
    return {std::move(to), std::move(cost)};
  }

  Point part_of_the_way(const InsStep& step, double share) const {
    return reached(fit.unknowns, {share * step.band, share * step.border, share * step.wander});
  }

  void accept(Point&& point) {
    fit.unknowns = std::move(point.unknowns);
    fit.cost = std::move(point.cost);
  }

  /// A little uphill is looked at from the other side: in a valley that bends, as an azimuth's that only disturbed
  /// magnetometers tell, a long step leaves the ground and the next one comes back to it, where steps that never rise
  /// creep.
  Point come_back(Point trial, bool hold_border) const {
    for (int look = 0;
         look < most_looks && trial.cost.total >= fit.cost.total && trial.cost.total < little_uphill * fit.cost.total;
         ++look) {
      const auto next = direction(trial.unknowns, hold_border);
      if (!next) break;
      trial = reached(trial.unknowns, *next);
    }
    return trial;
  }

  /// One accepted step; false where the ground is reached or no damping lowers the cost.
  bool step(bool hold_border) {
    for (; damping < most_damping; damping *= 10.0) {
      const auto first = direction(fit.unknowns, hold_border);
      if (!first) continue;
      Point trial = reached(fit.unknowns, *first);
      if (trial.cost.total < fit.cost.total) {
        accept(std::move(trial));
        damping = std::max(least_damping, 0.03 * damping);
        return true;
      }
      const double rise = trial.cost.total - fit.cost.total,
                   slope = (fit.cost.total - part_of_the_way(*first, short_way).cost.total) / short_way;
      if (slope < options.least_decrease) break;  // the ground; a more damped step promises less still
      // Robust weights that change on the way make the step too long: the parabola's lowest point is nearer.
      trial = rise < slope ? part_of_the_way(*first, 0.5 * slope / (slope + rise))
                           : come_back(std::move(trial), hold_border);
      if (trial.cost.total >= fit.cost.total) continue;
      accept(std::move(trial));
      return true;
    }
    damping = first_damping;
    return false;
  }

  /// True where the instruments' noise, as it is now, changed since the cost was computed.
  bool weigh() {
    const bool changed = reweigh(problem, fit.cost);
    fit.cost = cost_of(problem, fit.layout, fit.unknowns, options.threads);
    return changed;
  }

  /// Iterates until the cost falls by less than `least_decrease`, the round or the budget is over, or until the
  /// residuals have become so much smaller that the instruments are weighed wrongly.
  Stop round(int iterations, double least_decrease, const Observer& observer) {
    for (int i = 0; i < iterations && fit.iterations < options.iterations; ++i, ++fit.iterations) {
      if (i >= round_iterations && is_stale(problem, fit.cost)) return Stop::budget_spent;
      const double before = fit.cost.total;
      if (!step(false)) return Stop::stalled;
      const Progress progress{.stage = "estimate",
                              .fraction = static_cast<double>(fit.iterations) / options.iterations,
                              .best = fit.cost.total,
                              .median = 0.0,
                              .iteration = fit.iterations,
                              .detail = {}};
      if (tell(observer, progress) == Wish::stop) return Stop::cancelled;
      if (before - fit.cost.total < least_decrease && damping < first_damping) return Stop::converged_cost;
    }
    return Stop::budget_spent;
  }
};

}  // namespace

InsFit fit_ins(InsProblem& problem, const InsUnknowns& start, const InsFitOptions& options, const Observer& observer) {
  Marquardt m{problem, options, {start, layout_of(problem, start.bodies), {}}};
  InsFit& fit = m.fit;
  const auto stretches = static_cast<Eigen::Index>(stretches_of(problem.grid).size());
  if (fit.unknowns.wander.rows() != fit.layout.wander || fit.unknowns.wander.cols() != stretches)
    fit.unknowns.wander = MatrixXd::Zero(fit.layout.wander, stretches);
  fit.cost = cost_of(problem, fit.layout, fit.unknowns, options.threads);
  for (int i = 0; i < options.settling; ++i, ++fit.iterations) {
    m.weigh();
    m.step(true);
  }
  bool changed = m.weigh();
  for (int round = 0; round < options.rounds; ++round) {
    const bool rough = changed;
    fit.stop = rough ? m.round(round_iterations, rough_decrease, observer)
                     : m.round(options.iterations, options.least_decrease, observer);
    if (fit.stop == Stop::cancelled || fit.iterations >= options.iterations) break;
    const bool done = fit.stop != Stop::budget_spent;
    changed = m.weigh();
    if (done && !changed && !rough) break;
  }
  return fit;
}

}  // namespace kinfer
