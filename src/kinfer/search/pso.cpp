#include "kinfer/search/pso.hpp"

#include <algorithm>

#include "kinfer/base/expect.hpp"

namespace kinfer {
namespace {

double inertia_at(const PsoOptions& options, int iteration) {
  if (options.final_inertia < 0.0) return options.inertia;
  const double share = double(iteration) / std::max(1, options.budget.max_iterations);
  return options.inertia + share * (options.final_inertia - options.inertia);
}

/// Eq. (9) for one particle, in place.
void accelerate(Eigen::Ref<VectorXd> v, ConstVectorRef x, ConstVectorRef own_best, ConstVectorRef swarm_best, double w,
                const PsoOptions& options, Rng draw) {
  double r1 = draw.uniform(), r2 = draw.uniform();
  for (Eigen::Index d = 0; d < v.size(); ++d) {
    if (d > 0 && options.random_numbers == RandomNumbers::per_dimension) r1 = draw.uniform(), r2 = draw.uniform();
    v[d] = w * v[d] + options.own * r1 * (own_best[d] - x[d]) + options.swarm * r2 * (swarm_best[d] - x[d]);
  }
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
  const VectorXd fastest = 2.0 * options.velocity_limit * objective.bounds.half_width();

  MatrixXd x = first_swarm(objective, options, rng.stream(0));
  MatrixXd v = MatrixXd::Zero(x.rows(), x.cols());
  Memory own;
  for (int iteration = 1;; ++iteration) {
    const std::vector<double> cost = judge(x);
    own.update(x, cost);
    if (record.note(x, cost)) break;

    if (before_every_update) x = clamped(before_every_update(x), objective.bounds);
    const double w = inertia_at(options, iteration);
    const Rng draws = moves.stream(iteration);
    for (Eigen::Index p = 0; p < x.cols(); ++p)
      accelerate(v.col(p), x.col(p), own.x.col(p), record.best(), w, options, draws.stream(p));
    if (options.velocity_limit > 0.0) v = clamped(v, {-fastest, fastest});
    x += v;
    if (options.walls == Walls::open) continue;
    const MatrixXd inside = clamped(x, objective.bounds);
    if (options.walls == Walls::absorb) v = (x.array() == inside.array()).select(v, 0.0);
    x = inside;
  }
  return record.finish(judge, std::move(x));
}

}  // namespace kinfer
