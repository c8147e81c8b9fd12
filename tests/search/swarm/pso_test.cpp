// SPDX-License-Identifier: Apache-2.0
#include "kinfer/search/swarm/pso.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "kinfer/search/swarm/minimise.hpp"
#include "search/swarm_problems.hpp"

namespace kinfer {
namespace {

using testing::cube;
using testing::objective_of;
using testing::rastrigin;
using testing::shifted_sphere;

/// Reference: eqs. (9) and (10) for one number of one particle, with the same random draws.
MatrixXd slow_swarm(const PsoOptions& options, int iterations, Rng rng) {
  const Bounds box = cube(2, 1.0);
  const auto cost = [](const VectorXd& x) { return (x.array() - 0.3).square().sum(); };
  MatrixXd x = uniform_swarm(box, options.particles, rng.stream(0)), v = MatrixXd::Zero(2, options.particles), own = x;
  for (int t = 1; t <= iterations; ++t) {
    VectorXd g = own.col(0);
    for (int p = 0; p < options.particles; ++p)
      if (cost(own.col(p)) < cost(g)) g = own.col(p);
    for (int p = 0; p < options.particles; ++p) {
      Rng draw = rng.stream(1).stream(t).stream(p);
      for (int d = 0; d < 2; ++d) {
        const double r1 = draw.uniform(), r2 = draw.uniform();
        v(d, p) = options.inertia * v(d, p) + options.cognitive * r1 * (own(d, p) - x(d, p)) +
                  options.social * r2 * (g[d] - x(d, p));
        x(d, p) = std::clamp(x(d, p) + v(d, p), -1.0, 1.0);
      }
      if (cost(x.col(p)) < cost(own.col(p))) own.col(p) = x.col(p);
    }
  }
  return x;
}

TEST(Pso, UpdatesByEquations9And10) {
  const PsoOptions options{.particles = 7, .boundary = BoundaryHandling::clamp, .budget = {.max_iterations = 30}};
  const SearchOutcome outcome = particle_swarm(shifted_sphere(2), options, Rng(3));
  EXPECT_TRUE(outcome.final_swarm.isApprox(slow_swarm(options, 30, Rng(3)), 1e-13));
}

TEST(Pso, FindsTheMinimumOfAQuadraticIn24Dimensions) {
  const SearchOutcome outcome = particle_swarm(shifted_sphere(24), {.budget = {.max_iterations = 600}}, Rng(1));
  EXPECT_LT((outcome.x.array() - 0.3).abs().maxCoeff(), 1e-3);
}

TEST(Pso, FindsTheGlobalOfManyLocalMinima) {
  const SearchOutcome outcome = particle_swarm(rastrigin(3), {.budget = {.max_iterations = 300}}, Rng(1));
  EXPECT_LT(outcome.x.norm(), 1e-4);
}

TEST(Pso, HistoryNeverRisesAndCountsEveryCandidate) {
  const SearchOutcome outcome =
      particle_swarm(rastrigin(4), {.particles = 30, .budget = {.max_iterations = 50}}, Rng(2));
  EXPECT_TRUE(std::is_sorted(outcome.best.rbegin(), outcome.best.rend()));
  EXPECT_EQ(outcome.best.size(), 51u);
  EXPECT_EQ(outcome.median.size(), 51u);
  EXPECT_EQ(outcome.iterations, 50);
  EXPECT_EQ(outcome.evaluations, 51 * 30);
  EXPECT_EQ(outcome.stop, Stop::budget_spent);
  EXPECT_EQ(outcome.best.back(), outcome.cost);
}

TEST(Pso, EndsAtTheTargetWithoutAnUpdateWhenTheFirstSwarmReachesIt) {
  PsoOptions options{.particles = 5, .budget = {.target_cost = 1e-20}};
  options.initial = MatrixXd::Constant(3, 5, 0.3);
  const SearchOutcome outcome = particle_swarm(shifted_sphere(3), options, Rng(1));
  EXPECT_EQ(outcome.stop, Stop::target_reached);
  EXPECT_EQ(outcome.iterations, 0);
  EXPECT_EQ(outcome.evaluations, 5);
}

TEST(Pso, ClampedParticlesStayInTheBoxAndOpenOnesMayLeaveIt) {
  // The minimum lies outside, beyond the upper bound.
  const Objective objective =
      objective_of(cube(2, 1.0), [](const VectorXd& x) { return (x.array() - 3.0).square().sum(); });
  PsoOptions options{.budget = {.max_iterations = 100}};
  EXPECT_TRUE(particle_swarm(objective, options, Rng(1)).x.isApprox(VectorXd::Ones(2)));
  options.boundary = BoundaryHandling::open;
  EXPECT_TRUE(particle_swarm(objective, options, Rng(1)).x.isApprox(VectorXd::Constant(2, 3.0), 1e-3));
}

TEST(Pso, VelocityLimitBoundsEveryStep) {
  PsoOptions options{.particles = 20, .velocity_limit = 0.01, .budget = {.max_iterations = 1}};
  const SearchOutcome outcome = particle_swarm(shifted_sphere(3), options, Rng(1));
  EXPECT_LE((outcome.final_swarm - outcome.initial_swarm).cwiseAbs().maxCoeff(), 0.01 * 2.0 + 1e-15);
}

TEST(Pso, OneRandomNumberPerParticleKeepsTheFirstStepOnALineThroughTheBest) {
  // From rest, own best = x: v = c2 r2 (g − x) points at the best particle only when r2 is one number.
  const auto largest_sine = [](RandomNumbers numbers) {
    const PsoOptions options{.particles = 20, .random_numbers = numbers, .budget = {.max_iterations = 1}};
    const SearchOutcome outcome = particle_swarm(shifted_sphere(3), options, Rng(1));
    Eigen::Index best = 0;
    (outcome.initial_swarm.array() - 0.3).square().colwise().sum().minCoeff(&best);
    double sine = 0.0;
    for (Eigen::Index p = 0; p < 20; ++p) {
      const Eigen::Vector3d step = outcome.final_swarm.col(p) - outcome.initial_swarm.col(p);
      const Eigen::Vector3d way = outcome.initial_swarm.col(best) - outcome.initial_swarm.col(p);
      if (p != best) sine = std::max(sine, step.cross(way).norm() / (step.norm() * way.norm()));
    }
    return sine;
  };
  EXPECT_LT(largest_sine(RandomNumbers::per_particle), 1e-12);
  EXPECT_GT(largest_sine(RandomNumbers::per_dimension), 1e-2);
}

TEST(Pso, ThePrintedInertiaContractsFarLessThanTheDefault) {
  PsoOptions printed = pso_as_printed();
  printed.budget = {.max_iterations = 300};
  PsoOptions fallen = printed, usual = printed;
  fallen.final_inertia = 0.6;
  usual.inertia = PsoOptions{}.inertia;
  const double slow = particle_swarm(shifted_sphere(24), printed, Rng(1)).cost;
  EXPECT_GT(slow, 10.0 * particle_swarm(shifted_sphere(24), usual, Rng(1)).cost);
  EXPECT_GT(slow, 10.0 * particle_swarm(shifted_sphere(24), fallen, Rng(1)).cost);
}

TEST(Pso, AbsorbingBoundsFreeASwarmThatClampingTraps) {
  // With this seed all particles reach x_d = 1 in some dimension d, and so do their personal bests.
  PsoOptions options = pso_as_printed();
  options.budget = {.max_iterations = 1000};
  options.boundary = BoundaryHandling::clamp;
  const double stuck = particle_swarm(shifted_sphere(24), options, Rng(1)).cost;
  options.boundary = BoundaryHandling::absorb;
  EXPECT_NEAR(stuck, 0.49, 1e-2);
  EXPECT_LT(particle_swarm(shifted_sphere(24), options, Rng(1)).cost, 0.01);
}

TEST(Pso, CostsThatAreNotFiniteAreInfiniteAndCounted) {
  const Objective objective = objective_of(cube(2, 1.0), [](const VectorXd& x) { return x[0] < 0.0 ? NAN : x[0]; });
  const SearchOutcome outcome = particle_swarm(objective, {.budget = {.max_iterations = 20}}, Rng(1));
  EXPECT_GT(outcome.not_finite, 0);
  EXPECT_GE(outcome.x[0], 0.0);
  EXPECT_LT(outcome.cost, 0.1);
  const Objective hopeless = objective_of(cube(2, 1.0), [](const VectorXd&) { return NAN; });
  EXPECT_EQ(particle_swarm(hopeless, {.budget = {.max_iterations = 3}}, Rng(1)).stop, Stop::not_finite);
}

TEST(Pso, AStagnatingSearchEndsBeforeItsBudget) {
  // The quadratic of 24 dimensions with a floor, below which no cost can be found.
  const Objective bowl = shifted_sphere(24);
  const Objective with_floor{bowl.bounds, [bowl](ConstMatrixRef x, std::span<double> cost) {
                               bowl.evaluate(x, cost);
                               for (double& c : cost) c += 1e-3;
                             }};
  PsoOptions options;
  options.budget = {.max_iterations = 100000, .patience = 100};
  const SearchOutcome outcome = particle_swarm(with_floor, options, Rng(1));
  EXPECT_EQ(outcome.stop, Stop::converged_cost);
  EXPECT_LT(outcome.iterations, 1000);
  EXPECT_LT(outcome.cost, 1.02e-3);
}

TEST(Pso, AnObserverMayStopIt) {
  const auto stop_at_5 = [](const Progress& progress) {
    return progress.iteration == 5 ? ObserverDecision::stop : ObserverDecision::proceed;
  };
  const SearchOutcome outcome = particle_swarm(shifted_sphere(3), {}, Rng(1), stop_at_5);
  EXPECT_EQ(outcome.iterations, 5);
  EXPECT_EQ(outcome.stop, Stop::cancelled);
}

TEST(Minimise, EverySearchGivesTheSameBitsFor12And7Threads) {
  const auto with_threads = [](const SearchOptions& options, int threads) {
    const Budget budget{.max_iterations = 40, .threads = threads};
    return minimise(rastrigin(6), with_budget(options, budget), Rng(4));
  };
  std::vector<SearchOptions> all{BpnnPsoOptions{.hidden_nodes = HiddenNodes::stepwise, .training = {.epochs = 20}}};
  for (const SwarmMethod& method : swarm_methods()) all.push_back(method.default_options);
  for (const SearchOptions& options : all) {
    const SearchOutcome one = with_threads(options, 1);
    for (const int threads : {2, 7}) {
      const SearchOutcome other = with_threads(options, threads);
      EXPECT_EQ(one.x, other.x);
      EXPECT_EQ(one.best, other.best);
      EXPECT_EQ(one.final_swarm, other.final_swarm);
      if (one.net) {
        EXPECT_EQ(format_mlp(*one.net), format_mlp(*other.net));
      }
    }
  }
}

TEST(SearchMethods, OptionsFindTheirRowAndNamesTheirOptions) {
  for (const SwarmMethod& method : swarm_methods()) {
    EXPECT_EQ(&method_of(method.default_options), &method);
    EXPECT_EQ(method_named(method.name), &method);
  }
  EXPECT_EQ(method_of(QpsoOptions{}).name, "qpso");
  EXPECT_EQ(method_named("lm"), nullptr);
}

TEST(SearchMethods, BudgetParticlesAndInitialSwarmAreThoseOfTheRun) {
  const Bounds box = shifted_sphere(3).bounds;
  for (const SwarmMethod& method : swarm_methods()) {
    SearchOptions options = with_budget(method.default_options, {.max_iterations = 2});
    method.particles(options) = 5;
    if (method.takes_initial_swarm) method.initial(options) = box.center().replicate(1, 5);
    const SearchOutcome outcome = minimise(shifted_sphere(3), options, Rng(1));
    EXPECT_EQ(outcome.iterations, 2) << method.name;
    EXPECT_EQ(outcome.initial_swarm.cols(), 5) << method.name;
    if (!method.takes_initial_swarm) continue;
    EXPECT_EQ(outcome.initial_swarm, box.center().replicate(1, 5)) << method.name;
  }
}

TEST(SearchMethods, TheDescriptionNamesTheOptionsThatHaveAnEffect) {
  const auto value = [](const SearchOptions& options, std::string_view name) {
    for (const auto& [key, text] : describe(options))
      if (key == name) return text;
    return std::string();
  };
  PsoOptions pso{.particles = 60, .inertia = 0.7, .boundary = BoundaryHandling::open, .budget = {.max_iterations = 30}};
  EXPECT_EQ(value(pso, "particles"), "60");
  EXPECT_EQ(value(pso, "iterations"), "30");
  EXPECT_EQ(value(pso, "inertia"), "0.7");
  EXPECT_EQ(value(pso, "walls"), "open");
  EXPECT_EQ(value(pso, "net-use"), "");
  EXPECT_EQ(value(QpsoOptions{}, "inertia"), "");
  EXPECT_EQ(value(BpnnPsoOptions{.pso = pso, .use = NetUse::before_every_update}, "net-use"), "every-update");
}

}  // namespace
}  // namespace kinfer
