// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/loops/loop_fit.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/estimate/continuous/fit_comparison.hpp"
#include "kinfer/identify/loops/thresholds.hpp"

namespace kinfer::identify {
namespace {

using Index = Eigen::Index;

void set_loops(InsProblem& problem, InsUnknowns& x, const std::vector<FoundLoop>& loops) {
  problem.facts.closures.clear();
  x.facts.closures.clear();
  for (const FoundLoop& loop : loops) {
    problem.facts.closures.push_back(closure_of(loop, problem.grid));
    x.facts.closures.push_back(problem.facts.closures.back().start);
  }
}

std::vector<InsNoise> sensor_noise(const InsProblem& problem) {
  std::vector<InsNoise> noise;
  for (const InsMeasurements& sensor : problem.sensors) noise.push_back(sensor.noise);
  return noise;
}

}  // namespace

InsClosure closure_of(const FoundLoop& loop, const SplineGrid& grid) {
  InsClosure closure{.first = static_cast<int>(loop.first),
                     .second = static_cast<int>(loop.second),
                     .start = loop.evidence.closing.joint};
  const Index stride = 1 + grid.intervals / max_closure_times;
  for (Index k = 0; k < grid.intervals; k += stride)
    closure.at.push_back(grid.begin + grid.period * (static_cast<double>(k) + 0.5));
  const double times_per_second = 1.0 / (grid.period * static_cast<double>(stride));
  const double repeated = std::sqrt(std::max(1.0, times_per_second));
  closure.point_sd = closure_point_sd * repeated;
  closure.axis_sd = closure_axis_sd * repeated;
  return closure;
}

std::vector<FoundLoop> close_loops(InsProblem& problem, InsFit& fit, const InsFitOptions& options) {
  std::vector<FoundLoop> loops = find_loops(problem, fit);
  if (loops.empty()) return loops;
  const double open = negative_log_likelihood(problem, fit.cost);
  const std::vector<InsNoise> noise = sensor_noise(problem);
  while (!loops.empty()) {
    InsUnknowns start = fit.unknowns;
    set_loops(problem, start, loops);
    InsFit closed = fit_ins(problem, start, options);
    double odds = 0.0;
    for (const FoundLoop& loop : loops) odds += loop.log_odds;
    if (negative_log_likelihood(problem, closed.cost) - open < 2.0 * odds) {
      fit = std::move(closed);
      return loops;
    }
    loops.pop_back();  // the least likely one
    for (std::size_t s = 0; s < noise.size(); ++s) problem.sensors[s].noise = noise[s];
  }
  problem.facts.closures.clear();
  return loops;
}

}  // namespace kinfer::identify
