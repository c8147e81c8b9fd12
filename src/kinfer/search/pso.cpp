#include "kinfer/search/pso.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <vector>

#include "kinfer/base/expect.hpp"

namespace kinfer {
namespace {

double inertia_at(const PsoOptions& options, int iteration) {
  if (options.final_inertia < 0.0) return options.inertia;
  const double share = double(iteration) / std::max(1, options.budget.max_iterations);
  return options.inertia + share * (options.final_inertia - options.inertia);
}

/// r1 and r2 of eq. (9), alternating: a pair a dimension, or the same pair for all.
void draw_pairs(RandomNumbers how, Rng draw, std::span<double> pairs) {
  if (how == RandomNumbers::per_dimension) return draw.uniform(pairs);
  draw.uniform(pairs.first(2));
  for (std::size_t i = 2; i < pairs.size(); ++i) pairs[i] = pairs[i - 2];
}

/// Eqs. (9) and (10) for one particle, in place. `to` is a buffer of the hot loop.
void move(double* v, double* x, const double* own_best, const double* swarm_best, const double* pairs, double w,
          const PsoOptions& options, const VectorXd& fastest, const Bounds& box, VectorXd& to) {
  const double own = options.own, swarm = options.swarm;
  const Eigen::Index dim = fastest.size();
  const double* limit = fastest.data();
  for (Eigen::Index d = 0; d < dim; ++d) {
    const double pull = own * pairs[2 * d] * (own_best[d] - x[d]) + swarm * pairs[2 * d + 1] * (swarm_best[d] - x[d]);
    v[d] = std::min(std::max(w * v[d] + pull, -limit[d]), limit[d]);
  }
  Eigen::Map<VectorXd> at(x, dim);
  to = at + Eigen::Map<const VectorXd>(v, dim);
  if (options.walls == Walls::open) {
    at = to;
    return;
  }
  at = to.cwiseMax(box.lower).cwiseMin(box.upper);
  // Most particles stay inside: compared as bytes, which is fastest.
  if (options.walls != Walls::absorb || std::memcmp(x, to.data(), dim * sizeof(double)) == 0) return;
  for (Eigen::Index d = 0; d < dim; ++d)
    if (x[d] != to[d]) v[d] = 0.0;
}

MatrixXd first_swarm(const Objective& objective, const PsoOptions& options, Rng rng) {
  if (options.initial.size() == 0) return uniform_swarm(objective.bounds, options.particles, rng);
  KINFER_EXPECT(options.initial.rows() == objective.bounds.size() && options.initial.cols() > 0,
                "an initial swarm of {} x {} in a box of {}", options.initial.rows(), options.initial.cols(),
                objective.bounds.size());
  return clamped(options.initial, objective.bounds);
}

}  // namespace

Outcome particle_swarm(const Objective& objective, const PsoOptions& options, Rng rng, const Observer& observer,
                       const SwarmMap& before_every_update) {
  Judge judge(objective, options.budget.threads);
  Record record(options.budget, observer);
  const Rng moves = rng.stream(1);
  const VectorXd fastest = options.velocity_limit > 0.0
                               ? VectorXd(2.0 * options.velocity_limit * objective.bounds.half_width())
                               : VectorXd::Constant(objective.bounds.size(), std::numeric_limits<double>::infinity());

  MatrixXd x = first_swarm(objective, options, rng.stream(0));
  MatrixXd v = MatrixXd::Zero(x.rows(), x.cols());
  Memory own;
  std::vector<double> pairs(2 * x.rows());
  VectorXd to(x.rows());
  for (int iteration = 1;; ++iteration) {
    const std::vector<double> cost = judge(x);
    own.update(x, cost);
    if (record.note(x, cost)) break;

    if (before_every_update) x = clamped(before_every_update(x), objective.bounds);
    const double w = inertia_at(options, iteration);
    const Rng draws = moves.stream(iteration);
    for (Eigen::Index p = 0; p < x.cols(); ++p) {
      draw_pairs(options.random_numbers, draws.stream(p), pairs);
      move(v.col(p).data(), x.col(p).data(), own.x.col(p).data(), record.best().data(), pairs.data(), w, options,
           fastest, objective.bounds, to);
    }
  }
  return record.finish(judge, std::move(x));
}

}  // namespace kinfer
