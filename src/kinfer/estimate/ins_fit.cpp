#include "kinfer/estimate/ins_fit.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/estimate/ins_noise.hpp"

namespace kinfer {
namespace {

constexpr double held = 1e12;  // damping that holds the border while the band settles
constexpr double first_damping = 1e-3, most_damping = 1e8;
constexpr double least_damping = 1e-14;  // must not hold a weakly known azimuth
constexpr int settling_iterations = 3;   // of the band alone
constexpr int round_iterations = 4;      // before the instruments are weighed anew

struct Marquardt {
  InsProblem& problem;
  const InsFitOptions& options;
  InsFit fit;
  double damping = first_damping;

  /// One accepted step; false where no damping lowers the cost.
  bool step(bool hold_border) {
    for (; damping < most_damping; damping *= 10.0) {
      const auto system =
          eliminated(problem, fit.layout, fit.unknowns, {damping, hold_border ? held : damping}, options.threads);
      const auto change = system.solve();
      if (!change) continue;
      InsUnknowns trial = changed(problem, fit.layout, fit.unknowns, change->band, change->border);
      InsCost cost = cost_of(problem, fit.layout, trial, options.threads);
      if (!(cost.total < fit.cost.total)) continue;
      fit.unknowns = std::move(trial);
      fit.cost = std::move(cost);
      damping = std::max(least_damping, 0.03 * damping);
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

  /// Iterates until the cost no longer falls, the round or the budget is over.
  Stop round(int iterations, const Observer& observer) {
    for (int i = 0; i < iterations && fit.iterations < options.iterations; ++i, ++fit.iterations) {
      const double before = fit.cost.total;
      if (!step(false)) return Stop::stalled;
      const Progress progress{.stage = "estimate",
                              .fraction = static_cast<double>(fit.iterations) / options.iterations,
                              .best = fit.cost.total,
                              .median = 0.0,
                              .iteration = fit.iterations,
                              .detail = {}};
      if (tell(observer, progress) == Wish::stop) return Stop::cancelled;
      if (before - fit.cost.total < options.least_decrease && damping < first_damping) return Stop::converged_cost;
    }
    return Stop::budget_spent;
  }
};

}  // namespace

InsFit fit_ins(InsProblem& problem, const InsUnknowns& start, const InsFitOptions& options, const Observer& observer) {
  Marquardt m{problem, options, {start, layout_of(problem, start.bodies), {}}};
  InsFit& fit = m.fit;
  fit.cost = cost_of(problem, fit.layout, fit.unknowns, options.threads);
  for (int i = 0; i < settling_iterations; ++i, ++fit.iterations) {
    m.weigh();
    m.step(true);
  }
  bool changed = m.weigh();
  for (int round = 0; round < options.rounds; ++round) {
    fit.stop = m.round(changed ? round_iterations : options.iterations, observer);
    if (fit.stop == Stop::cancelled || fit.iterations >= options.iterations) break;
    const bool done = fit.stop != Stop::budget_spent;
    changed = m.weigh();
    if (done && !changed) break;
  }
  return fit;
}

}  // namespace kinfer
