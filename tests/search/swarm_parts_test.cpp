// SPDX-License-Identifier: Apache-2.0
// The bookkeeping that all population searches share, and how genetic programming ends.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "kinfer/search/evolution/bacterial_programming.hpp"
#include "kinfer/search/evolution/genetic_programming.hpp"
#include "kinfer/search/least_squares/least_squares.hpp"
#include "kinfer/search/swarm/minimise.hpp"
#include "search/swarm_problems.hpp"

namespace kinfer {
namespace {

constexpr double no_cost = std::numeric_limits<double>::infinity();

TEST(Box, ClampsEveryColumnAndKnowsItsMiddle) {
  const Bounds box{(VectorXd(2) << -1, 2).finished(), (VectorXd(2) << 3, 2.5).finished()};
  EXPECT_EQ(box.size(), 2);
  EXPECT_EQ(box.center(), (VectorXd(2) << 1, 2.25).finished());
  EXPECT_EQ(box.half_width(), (VectorXd(2) << 2, 0.25).finished());
  const MatrixXd x = (MatrixXd(2, 3) << -5, 0, 9, 2.2, 1.0, 3.0).finished();
  EXPECT_EQ(clamped(x, box), (MatrixXd(2, 3) << -1, 0, 3, 2.2, 2.0, 2.5).finished());
  EXPECT_EQ(clamped(MatrixXd(2, 0), box).cols(), 0);
}

TEST(UniformSwarm, FillsTheBoxAndDoesNotDependOnItsNumber) {
  const Bounds box = testing::cube(3, 2.0);
  const MatrixXd few = uniform_swarm(box, 5, Rng(1)), many = uniform_swarm(box, 4000, Rng(1));
  EXPECT_EQ(few, many.leftCols(5));
  EXPECT_LE(many.cwiseAbs().maxCoeff(), 2.0);
  EXPECT_GT(many.maxCoeff(), 1.99);
  EXPECT_LT(many.minCoeff(), -1.99);
  EXPECT_LT(many.rowwise().mean().norm(), 0.15);
}

TEST(Evaluator, CountsCandidatesAndTakesWhatIsNotFiniteForInfinite) {
  const Objective objective = testing::objective_of(testing::cube(1, 1.0), [](const VectorXd& x) {
    return x[0] < 0.0 ? std::nan("") : x[0] > 0.9 ? -no_cost : x[0];
  });
  BatchEvaluator evaluator(objective, 2);
  const MatrixXd x = (MatrixXd(1, 4) << -0.5, 0.5, 0.95, 0.25).finished();
  EXPECT_EQ(evaluator(x), (std::vector<double>{no_cost, 0.5, no_cost, 0.25}));
  evaluator(x.leftCols(2));
  EXPECT_EQ(evaluator.evaluations(), 6);
  EXPECT_EQ(evaluator.not_finite(), 3);
  EXPECT_DEATH(evaluator(MatrixXd::Zero(2, 1)), "2 numbers in a box of 1");
}

/// Adds populations of one candidate each with these costs; the number of the one that ended the search.
int ended_at(const Budget& budget, const std::vector<double>& costs, SearchOutcome* outcome = nullptr) {
  const Observer nobody;
  SearchHistory history(budget, nobody);
  int ended = -1;
  for (std::size_t k = 0; k < costs.size() && ended < 0; ++k)
    if (history.add(MatrixXd::Constant(1, 1, static_cast<double>(k)), {costs[k]})) ended = static_cast<int>(k);
  const Objective objective = testing::shifted_sphere(1);
  if (outcome) *outcome = history.finish(BatchEvaluator(objective, 1), MatrixXd::Zero(1, 1));
  return ended;
}

TEST(History, KeepsTheBestCandidateAndNeverRises) {
  SearchOutcome outcome;
  EXPECT_EQ(ended_at({.max_iterations = 3}, {5.0, 2.0, 7.0, 3.0, 1.0}, &outcome), 3);
  EXPECT_EQ(outcome.best, (std::vector<double>{5.0, 2.0, 2.0, 2.0}));
  EXPECT_EQ(outcome.median, (std::vector<double>{5.0, 2.0, 7.0, 3.0}));
  EXPECT_EQ(outcome.x[0], 1.0);
  EXPECT_EQ(outcome.cost, 2.0);
  EXPECT_EQ(outcome.iterations, 3);
  EXPECT_EQ(outcome.stop, Stop::budget_spent);
}

TEST(History, EndsForTheReasonThatComesFirst) {
  SearchOutcome outcome;
  EXPECT_EQ(ended_at({.max_iterations = 9, .target_cost = 2.5}, {5.0, 2.0, 1.0}, &outcome), 1);
  EXPECT_EQ(outcome.stop, Stop::target_reached);
  EXPECT_EQ(ended_at({.max_iterations = 9, .patience = 2}, {5.0, 4.99, 4.98, 1.0}, &outcome), 2);
  EXPECT_EQ(outcome.stop, Stop::converged_cost);
  EXPECT_EQ(ended_at({.max_iterations = 9, .patience = 2}, {5.0, 4.8, 4.6, 4.4, 4.2}), -1) << "it gains 4 % at a time";
  EXPECT_EQ(ended_at({.max_iterations = 2, .patience = 1}, {no_cost, no_cost, no_cost}, &outcome), 2);
  EXPECT_EQ(outcome.stop, Stop::not_finite) << "nothing was found, so nothing stagnates";
  EXPECT_EQ(ended_at({.max_iterations = 0}, {5.0, 1.0}), 0);
}

TEST(PersonalBestsOf, EachParticleAreItsOwnLowest) {
  PersonalBests own;
  own.update((MatrixXd(1, 2) << 1, 2).finished(), {10.0, 20.0});
  own.update((MatrixXd(1, 2) << 3, 4).finished(), {11.0, 5.0});
  own.update((MatrixXd(1, 2) << 5, 6).finished(), {10.0, no_cost});
  EXPECT_EQ(own.x, (MatrixXd(1, 2) << 1, 4).finished());
  EXPECT_EQ(own.cost, (std::vector<double>{10.0, 5.0}));
}

TEST(EverySearch, ByItsOptionsFindsTheBowlFromAGivenSwarm) {
  const Objective bowl = testing::shifted_sphere(4);
  const MatrixXd start = uniform_swarm(bowl.bounds, 40, Rng(9));
  const Budget budget{.max_iterations = 150};
  for (const SearchOptions& options : {SearchOptions(PsoOptions{.initial = start, .budget = budget}),
                                       SearchOptions(QpsoOptions{.schedule = 100, .initial = start, .budget = budget}),
                                       SearchOptions(BpnnPsoOptions{.pso = {.initial = start, .budget = budget}})}) {
    const SearchOutcome found = minimise(bowl, options, Rng(2));
    EXPECT_EQ(found.initial_swarm, start) << options.index();
    EXPECT_LT((found.x.array() - 0.3).abs().maxCoeff(), 1e-3) << options.index();
    EXPECT_EQ(found.best.size(), static_cast<std::size_t>(found.iterations + 1));
  }
}

TEST(Qpso, AScheduleLongerThanTheSearchNeverContracts) {
  const auto width_after = [](int schedule) {
    const QpsoOptions options{.schedule = schedule, .budget = {.max_iterations = 100}};
    const SearchOutcome o = quantum_swarm(testing::shifted_sphere(5), options, Rng(1));
    return (o.final_swarm.colwise() - o.x).cwiseAbs().mean();
  };
  EXPECT_GT(width_after(100000), 10.0 * width_after(50));
}

/// Whole numbers whose parts are their digits; the cost is the distance from 4711.
struct DigitOperators {
  using Genome = std::array<int, 4>;
  Genome random(Rng rng) const {
    Genome digits{};
    for (int& digit : digits) digit = static_cast<int>(rng.index(10));
    return digits;
  }
  std::size_t part_count(const Genome&) const { return 4; }
  Genome mutate(Genome digits, std::size_t part, Rng rng) const {
    digits[part] = static_cast<int>(rng.index(10));
    return digits;
  }
  Genome transfer(const Genome& from, std::size_t part, Genome to, std::size_t place, Rng) const {
    to[place] = from[part];
    return to;
  }
};

double digit_errors(const DigitOperators::Genome& digits, double /*bound*/) {
  constexpr DigitOperators::Genome wanted{4, 7, 1, 1};
  double wrong = 0.0;
  for (std::size_t k = 0; k < 4; ++k) wrong += std::abs(digits[k] - wanted[k]);
  return wrong;
}

TEST(Evolution, EndsAtItsTargetCostAndSaysSo) {
  const GenomeCost<DigitOperators::Genome> cost(digit_errors);
  const auto bacteria = evolve_bacteria(DigitOperators{}, cost, {.individuals = 20, .target_cost = 0.0}, Rng(1));
  EXPECT_EQ(bacteria.stop, Stop::target_reached);
  EXPECT_EQ(bacteria.best, (DigitOperators::Genome{4, 7, 1, 1}));
  EXPECT_LT(bacteria.generations, 300);
  EXPECT_EQ(bacteria.best_history.size(), static_cast<std::size_t>(bacteria.generations + 1));
  EXPECT_EQ(bacteria.evaluations_at.back(), bacteria.evaluations);
}

TEST(Evolution, ByCrossoverFindsTheDigitsAndKeepsTheBest) {
  const GenomeCost<DigitOperators::Genome> cost(digit_errors);
  const auto outcome = evolve_by_crossover(DigitOperators{}, cost, {.individuals = 40, .generations = 60}, Rng(1));
  EXPECT_EQ(outcome.cost, 0.0);
  EXPECT_EQ(outcome.generations, 60) << "it has no target cost";
  EXPECT_EQ(outcome.evaluations, 40 + 60 * 39) << "the best one survives without another evaluation";
}

/// x² − 3 as one residual.
Residuals straight_line() {
  return {.unknowns = 1, .rows = 1, .blocks = {}, .evaluate = [](ConstVectorRef x, VectorXd& r, MatrixXd* jacobian) {
            r[0] = x[0] * x[0] - 3.0;
            if (jacobian) (*jacobian)(0, 0) = 2.0 * x[0];
          }};
}

TEST(FinalStepOf, LeastSquaresMaySaveItsLastEvaluation) {
  const VectorXd start = VectorXd::Constant(1, 2.0);
  const LeastSquaresOutcome all = least_squares(straight_line(), start),
                            saved = least_squares(straight_line(), start, {.final_step = FinalStep::skipped});
  EXPECT_NEAR(all.x[0], std::sqrt(3.0), 1e-12);
  EXPECT_NEAR(saved.x[0], std::sqrt(3.0), 1e-7);
  EXPECT_LE(saved.evaluations, all.evaluations);
}

}  // namespace
}  // namespace kinfer
