// SPDX-License-Identifier: Apache-2.0
#include "kinfer/search/swarm/qpso.hpp"

#include <algorithm>
#include <cmath>

namespace kinfer {
namespace {

double contraction_at(const QpsoOptions& options, int iteration) {
  const double share = std::min(1.0, double(iteration) / std::max(1, options.schedule));
  return options.contraction + share * (options.final_contraction - options.contraction);
}

}  // namespace

SearchOutcome quantum_swarm(const Objective& objective, const QpsoOptions& options, Rng rng, const Observer& observer) {
  BatchEvaluator evaluator(objective, options.budget.threads);
  SearchHistory history(options.budget, observer);
  const Rng moves = rng.stream(1);

  MatrixXd x = options.initial.size() > 0 ? clamped(options.initial, objective.bounds)
                                          : uniform_swarm(objective.bounds, options.particles, rng.stream(0));
  PersonalBests own;
  for (int iteration = 1;; ++iteration) {
    const std::vector<double> cost = evaluator(x);
    own.update(x, cost);
    if (history.add(x, cost)) break;

    const double beta = contraction_at(options, iteration);
    const VectorXd mean_best = own.x.rowwise().mean();
    for (Eigen::Index p = 0; p < x.cols(); ++p) {
      Rng draw = moves.stream(iteration).stream(p);
      for (Eigen::Index d = 0; d < x.rows(); ++d) {
        const double phi = draw.uniform(), u = 1.0 - draw.uniform();  // u is never 0
        const double attractor = phi * own.x(d, p) + (1.0 - phi) * history.best()[d];
        const double jump = beta * std::abs(mean_best[d] - x(d, p)) * -std::log(u);
        x(d, p) = draw.uniform() < 0.5 ? attractor + jump : attractor - jump;
      }
    }
    x = clamped(x, objective.bounds);
  }
  return history.finish(evaluator, std::move(x));
}

}  // namespace kinfer
