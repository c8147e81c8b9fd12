// Plain genetic programming (Koza 1992) over the same genomes and costs as search/bacterial.hpp: the baseline that
// paper 1 says bacterial programming beats.
//
// Each generation is made anew: the best individual stays; every other one is bred from parents that won a tournament,
// by sub-tree crossover or by renewing one part.
#pragma once

#include "kinfer/search/bacterial.hpp"

namespace kinfer {

struct GeneticOptions {
  int individuals = 100;
  int generations = 3660;  ///< as many evaluations as 300 generations of bacterial programming by default
  int tournament = 4;      ///< individuals drawn, of which the best breeds; more press harder
  double crossover = 0.8;  ///< probability of crossover; else a part is renewed
  int threads = 0;
};

template <Breed B>
EvolutionOutcome<typename B::Genome> evolve_by_crossover(const B& breed, const GenomeCost<typename B::Genome>& cost,
                                                         const GeneticOptions& options, const Rng& rng,
                                                         const Observer& observer = {}) {
  KINFER_EXPECT(options.individuals >= 2 && options.tournament >= 1);
  using Population = std::vector<Individual<typename B::Genome>>;
  const BacterialOptions limits{.individuals = options.individuals, .generations = options.generations};
  const auto size = static_cast<std::uint64_t>(options.individuals);
  const auto winner = [&](const Population& sorted, Rng& draw) -> const typename B::Genome& {
    std::uint64_t best = draw.index(size);
    for (int i = 1; i < options.tournament; ++i) best = std::min(best, draw.index(size));
    return sorted[best].genome;
  };
  EvolutionOutcome<typename B::Genome> outcome;
  Population population =
      evolution::initial_population(breed, cost, options.individuals, options.threads, rng.stream(0));
  outcome.evaluations = options.individuals;
  evolution::record(outcome, population);
  while (!evolution::is_over(outcome, limits, observer)) {
    const Rng generation = rng.stream(static_cast<std::uint64_t>(++outcome.generations));
    Population next(population.size());
    next[0] = population[0];
    parallel_for(population.size() - 1, options.threads, [&](std::size_t i) {
      Rng draw = generation.stream(i);
      const auto& mother = winner(population, draw);
      const std::size_t place = draw.index(breed.parts(mother));
      if (draw.uniform() < options.crossover) {
        const auto& father = winner(population, draw);
        const std::size_t part = draw.index(breed.parts(father));
        next[i + 1].genome = breed.transferred(father, part, mother, place, draw.stream(0));
      } else {
        next[i + 1].genome = breed.mutated(mother, place, draw.stream(0));
      }
      next[i + 1].cost = evolution::finite_or_infinite(cost, next[i + 1].genome, unbounded);
    });
    population = std::move(next);
    evolution::sort_by_cost(population);
    outcome.evaluations += options.individuals - 1;
    evolution::record(outcome, population);
  }
  return outcome;
}

}  // namespace kinfer
