// SPDX-License-Identifier: Apache-2.0
// Bacterial programming (Péntek et al. 2021, algorithms 1-3; Cabrita, Botzheim, Ruano, Kóczy 2006) over any genome.
//
// Bacterial mutation searches around each individual: in clones of it the same part is mutated in different ways, and
// the best clone replaces the individual, part after part. Gene transfer spreads good parts: a part of a superior
// individual overwrites a part of an inferior one. The genome type and its operators come from a Breed.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <functional>

#include "kinfer/base/expect.hpp"
#include "kinfer/base/observer.hpp"
#include "kinfer/base/parallel.hpp"
#include "kinfer/base/rng.hpp"
#include "kinfer/search/evolution/evolution_options.hpp"

namespace kinfer {

/// Operators on a genome: draw at random, mutate a part, transfer a part. Called from several threads at once.
template <class B>
concept GeneticOperators = std::copyable<typename B::Genome> &&
    requires(const B& operators, const typename B::Genome& genome, std::size_t part, Rng rng) {
  { operators.random(rng) } -> std::same_as<typename B::Genome>;
  { operators.part_count(genome) } -> std::convertible_to<std::size_t>;  // at least 1
  { operators.mutate(genome, part, rng) } -> std::same_as<typename B::Genome>;
  { operators.transfer(genome, part, genome, part, rng) } -> std::same_as<typename B::Genome>;  // from, to
};

/// Cost of a genome, the smaller the better. If it is not below `bound`, any number not below `bound` may be returned,
/// so that an evaluation may be aborted early. NaN counts as infinite.
template <class Genome>
using GenomeCost = std::function<double(const Genome&, double bound)>;

constexpr double unbounded = std::numeric_limits<double>::infinity();

template <class Genome>
struct Individual {
  Genome genome{};
  double cost = unbounded;
};

namespace evolution {

template <class Genome>
double evaluate_cost(const GenomeCost<Genome>& cost, const Genome& genome, double bound) {
  const double value = cost(genome, bound);
  return value < unbounded ? value : unbounded;
}

/// Algorithm 2 for one individual. Only a clone that is better than the best so far needs its exact cost.
template <GeneticOperators B>
Individual<typename B::Genome> bacterial_mutation(const B& operators, const GenomeCost<typename B::Genome>& cost,
                                                  Individual<typename B::Genome> individual,
                                                  const BacterialOptions& options, const Rng& rng) {
  for (int cycle = 0; cycle < options.cycles; ++cycle) {
    const Rng stream = rng.stream(static_cast<std::uint64_t>(cycle));
    const std::size_t part = stream.stream(0).index(operators.part_count(individual.genome));
    Individual<typename B::Genome> best = individual;  // the first clone keeps its part
    for (int clone = 1; clone < options.clones; ++clone) {
      auto genome = operators.mutate(individual.genome, part, stream.stream(static_cast<std::uint64_t>(clone)));
      const double value = evaluate_cost(cost, genome, best.cost);
      if (value < best.cost) best = {std::move(genome), value};
    }
    individual = std::move(best);
  }
  return individual;
}

template <class Genome>
void sort_by_cost(std::vector<Individual<Genome>>& population) {
  std::ranges::stable_sort(population, {}, &Individual<Genome>::cost);
}

/// Algorithm 3 on a sorted population, which it leaves sorted.
template <GeneticOperators B>
void gene_transfer(const B& operators, const GenomeCost<typename B::Genome>& cost,
                   std::vector<Individual<typename B::Genome>>& population, const BacterialOptions& options,
                   const Rng& rng) {
  const std::size_t half = population.size() / 2;
  for (int transfer = 0; transfer < options.transfers; ++transfer) {
    Rng draw = rng.stream(static_cast<std::uint64_t>(transfer));
    std::size_t superior = static_cast<std::size_t>(transfer) % half, inferior = population.size() - 1 - superior;
    if (options.pairing == Pairing::halves) {
      superior = draw.index(half);
      inferior = half + draw.index(population.size() - half);
    }
    const auto& from = population[superior].genome;
    auto& to = population[inferior];
    const std::size_t part = draw.index(operators.part_count(from)),
                      place = draw.index(operators.part_count(to.genome));
    to.genome = operators.transfer(from, part, to.genome, place, draw.stream(0));
    to.cost = evaluate_cost(cost, to.genome, unbounded);
    sort_by_cost(population);
  }
}

template <class Genome>
void record(EvolutionOutcome<Genome>& outcome, const std::vector<Individual<Genome>>& sorted) {
  outcome.best = sorted.front().genome;
  outcome.cost = sorted.front().cost;
  outcome.best_history.push_back(outcome.cost);
  outcome.median_history.push_back(sorted[sorted.size() / 2].cost);
  outcome.evaluations_at.push_back(outcome.evaluations);
}

/// A population drawn at random, evaluated and sorted.
template <GeneticOperators B>
std::vector<Individual<typename B::Genome>> initial_population(const B& operators,
                                                               const GenomeCost<typename B::Genome>& cost,
                                                               int individuals, int threads, const Rng& rng) {
  std::vector<Individual<typename B::Genome>> population(static_cast<std::size_t>(individuals));
  parallel_for(population.size(), threads, [&](std::size_t i) {
    population[i].genome = operators.random(rng.stream(i));
    population[i].cost = evaluate_cost(cost, population[i].genome, unbounded);
  });
  sort_by_cost(population);
  return population;
}

/// Notifies the observer; true if the search must end, with the reason in the outcome.
template <class Genome>
bool is_finished(EvolutionOutcome<Genome>& outcome, const BacterialOptions& options, const Observer& observer) {
  const Progress progress{.stage = "search",
                          .fraction = outcome.generations / std::max(1.0, static_cast<double>(options.generations)),
                          .best = outcome.cost,
                          .median = outcome.median_history.back(),
                          .iteration = outcome.generations,
                          .detail = {}};
  if (notify(observer, progress) == ObserverDecision::stop)
    outcome.stop = Stop::cancelled;
  else if (outcome.cost <= options.target_cost)
    outcome.stop = Stop::target_reached;
  else
    return outcome.generations >= options.generations;
  return true;
}

}  // namespace evolution

/// Algorithm 1. Random streams are keyed by (generation, individual, cycle, clone), so any number of threads gives the
/// same result.
template <GeneticOperators B>
EvolutionOutcome<typename B::Genome> evolve_bacteria(const B& operators, const GenomeCost<typename B::Genome>& cost,
                                                     const BacterialOptions& options, const Rng& rng,
                                                     const Observer& observer = {}) {
  KINFER_EXPECT(options.individuals >= 2 && options.clones >= 1 && options.cycles >= 0 && options.transfers >= 0);
  EvolutionOutcome<typename B::Genome> outcome;
  auto population = evolution::initial_population(operators, cost, options.individuals, options.threads, rng.stream(0));
  outcome.evaluations = options.individuals;
  evolution::record(outcome, population);
  while (!evolution::is_finished(outcome, options, observer)) {
    const Rng generation = rng.stream(static_cast<std::uint64_t>(++outcome.generations));
    parallel_for(population.size(), options.threads, [&](std::size_t i) {
      population[i] = evolution::bacterial_mutation(operators, cost, population[i], options, generation.stream(i));
    });
    evolution::sort_by_cost(population);
    evolution::gene_transfer(operators, cost, population, options, generation.stream(population.size()));
    outcome.evaluations +=
        static_cast<std::int64_t>(options.individuals) * options.cycles * (options.clones - 1) + options.transfers;
    evolution::record(outcome, population);
  }
  return outcome;
}

}  // namespace kinfer
