#include "kinfer/estimate/ins_fit.hpp"

#include <algorithm>
#include <cmath>

namespace kinfer {
namespace {

constexpr double held = 1e12;  // damping that holds the border while the band settles
constexpr double most_damping = 1e8;
constexpr int settling_iterations = 3;  // of the band alone

struct Marquardt {
  const InsProblem& problem;
  const InsFitOptions& options;
  InsFit fit;
  double damping = 1e-3;

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
      damping = std::max(1e-9, 0.1 * damping);
      return true;
    }
    return false;
  }
};

}  // namespace

InsFit fit_ins(const InsProblem& problem, const InsUnknowns& start, const InsFitOptions& options,
               const Observer& observer) {
  Marquardt m{problem, options, {start, layout_of(problem, start.bodies), {}}};
  m.fit.cost = cost_of(problem, m.fit.layout, start, options.threads);
  for (InsFit& fit = m.fit; fit.iterations < options.iterations; ++fit.iterations) {
    const double before = fit.cost.total;
    const bool settling = fit.iterations < settling_iterations;
    if (!m.step(settling)) {
      m.damping = 1e-3;
      if (settling) continue;
      fit.stop = Stop::stalled;
      break;
    }
    if (tell(observer, {.stage = "estimate",
                        .fraction = static_cast<double>(fit.iterations) / options.iterations,
                        .best = fit.cost.total,
                        .median = 0.0,
                        .iteration = fit.iterations,
                        .detail = {}}) == Wish::stop) {
      fit.stop = Stop::cancelled;
      break;
    }
    if (!settling && before - fit.cost.total < options.least_decrease * before && m.damping < 1e-3) {
      fit.stop = Stop::converged_cost;
      break;
    }
  }
  return m.fit;
}

}  // namespace kinfer
