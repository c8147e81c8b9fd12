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
  std::optional<Point> stepped(const InsUnknowns& from, bool hold_border) const {
    const InsSystem system(problem, fit.layout, from, {damping, damping, hold_border}, options.threads);
    const auto change = system.solve();
    if (!change) return std::nullopt;
    InsUnknowns to = changed(problem, fit.layout, from, *change);
    InsCost cost = cost_of(problem, fit.layout, to, options.threads);
    return Point{std::move(to), std::move(cost)};
  }

  /// One accepted step; false where no damping lowers the cost. A little uphill is looked at from the other side first:
  /// in a valley that bends, as an azimuth's that only disturbed magnetometers tell, a long step leaves the ground and
  /// the next one comes back to it, where steps that never rise creep.
  bool step(bool hold_border) {
    for (; damping < most_damping; damping *= 10.0) {
      auto trial = stepped(fit.unknowns, hold_border);
      for (int look = 0; look < most_looks && trial && !(trial->cost.total < fit.cost.total) &&
                         trial->cost.total < little_uphill * fit.cost.total;
           ++look)
        trial = stepped(trial->unknowns, hold_border);
      if (!trial || !(trial->cost.total < fit.cost.total)) continue;
      fit.unknowns = std::move(trial->unknowns);
      fit.cost = std::move(trial->cost);
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

  /// Iterates until the cost falls by less than `least_decrease`, the round or the budget is over.
  Stop round(int iterations, double least_decrease, const Observer& observer) {
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
