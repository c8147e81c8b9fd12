// SPDX-License-Identifier: Apache-2.0
// Settings and results shared by all evolutionary searches over genomes (paper 1, table 4).
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "kinfer/base/stop.hpp"

namespace kinfer {

/// Which inferior bacterium receives a gene from the i-th best one.
enum class Pairing {
  halves,   ///< one drawn from each half of the sorted population, as in the text of paper 1
  mirrored  ///< the (N + 1 - i)-th, as in the pseudo code of paper 1 (algorithm 3)
};

/// Of table 4 of paper 1, only individuals and generations are legible; the other defaults are common values.
struct BacterialOptions {
  int individuals = 100;
  int generations = 300;
  int clones = 5;      ///< of each individual, itself included; more search longer in each part
  int cycles = 3;      ///< parts of each individual that are mutated in one generation
  int transfers = 20;  ///< gene transfers from superior to inferior individuals in one generation; more converge sooner
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
