// Settings and results that all engines of evolving genomes share (paper 1, table 4).
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "kinfer/base/stop.hpp"

namespace kinfer {

/// Which inferior bacterium receives a gene from the i-th best one.
enum class Pairing {
  halves,   ///< one drawn from each half of the sorted population, as paper 1's text has it
  mirrored  ///< the (N + 1 - i)-th, as paper 1's pseudo code (algorithm 3) has it
};

/// Paper 1's table 4 is lost but for individuals and generations; the other defaults are usual ones.
struct BacterialOptions {
  int individuals = 100;
  int generations = 300;
  int clones = 5;  ///< of each individual, itself included; more search longer in each part
  int cycles = 3;  ///< parts of each individual that are renewed in one generation
  int transfers =
      20;  ///< genes that pass from superior to inferior individuals in one generation; more converge sooner
  Pairing pairing = Pairing::halves;
  double target_cost = -std::numeric_limits<double>::infinity();  ///< ends when the best cost is not above it
  int threads = 0;                                                ///< 0: all cores; the result does not depend on it
};

template <class Genome>
struct EvolutionOutcome {
  Genome best{};
  double cost = std::numeric_limits<double>::infinity();
  std::vector<double> best_history;          ///< best cost after the start and after each generation; never rises
  std::vector<double> median_history;        ///< of the population
  std::vector<std::int64_t> evaluations_at;  ///< evaluations spent so far, at the same times
  std::int64_t evaluations = 0;
  int generations = 0;
  Stop stop = Stop::budget_spent;
};

}  // namespace kinfer
