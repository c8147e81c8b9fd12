// SPDX-License-Identifier: Apache-2.0
// Genetic programming (Koza 1992) over the same genomes and costs as bacterial programming: the baseline that
// bacterial programming outperforms according to paper 1.
//
// In each generation the best individual is kept; every other one is an offspring of tournament winners, by sub-tree
// crossover or by mutation of one part.
#pragma once

#include "kinfer/search/evolution/bacterial_programming.hpp"

namespace kinfer {

struct GeneticOptions {
  int individuals = 100;
  int generations = 3660;  ///< as many evaluations as 300 generations of bacterial programming with its defaults
  int tournament = 4;      ///< individuals drawn, of which the best becomes a parent; more: higher selection pressure
  double crossover = 0.8;  ///< probability of crossover; else a part is mutated
  int threads = 0;
};

template <GeneticOperators B>
EvolutionOutcome<typename B::Genome> evolve_by_crossover(const B& operators, const GenomeCost<typename B::Genome>& cost,
                                                         const GeneticOptions& options, const Rng& rng,
                                                         const Observer& observer = {}) {
  KINFER_EXPECT(options.individuals >= 2 && options.tournament >= 1);
  using Population = std::vector<Individual<typename B::Genome>>;
  const BacterialOptions limits{.individuals = options.individuals, .generations = options.generations};
  const auto size = static_cast<std::uint64_t>(options.individuals);
  const auto tournament_winner = [&](const Population& sorted, Rng& draw) -> const typename B::Genome& {
    std::uint64_t best = draw.index(size);
    for (int i = 1; i < options.tournament; ++i) best = std::min(best, draw.index(size));
    return sorted[best].genome;
  };
  EvolutionOutcome<typename B::Genome> outcome;
  Population population =
      evolution::initial_population(operators, cost, options.individuals, options.threads, rng.stream(0));
  outcome.evaluations = options.individuals;
  evolution::record(outcome, population);
  while (!evolution::is_finished(outcome, limits, observer)) {
    const Rng generation = rng.stream(static_cast<std::uint64_t>(++outcome.generations));
    Population next(population.size());
    next[0] = population[0];
    parallel_for(population.size() - 1, options.threads, [&](std::size_t i) {
      Rng draw = generation.stream(i);
      const auto& mother = tournament_winner(population, draw);
      const std::size_t place = draw.index(operators.part_count(mother));
      if (draw.uniform() < options.crossover) {
        const auto& father = tournament_winner(population, draw);
        const std::size_t part = draw.index(operators.part_count(father));
        next[i + 1].genome = operators.transfer(father, part, mother, place, draw.stream(0));
      } else {
        next[i + 1].genome = operators.mutate(mother, place, draw.stream(0));
      }
      next[i + 1].cost = evolution::evaluate_cost(cost, next[i + 1].genome, unbounded);
    });
    population = std::move(next);
    evolution::sort_by_cost(population);
    outcome.evaluations += options.individuals - 1;
    evolution::record(outcome, population);
  }
  return outcome;
}

}  // namespace kinfer
