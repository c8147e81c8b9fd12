// SPDX-License-Identifier: Apache-2.0
// All methods on one problem type over many seeds, and the table of their medians.
#pragma once

#include <functional>

#include "methods.hpp"
#include "output.hpp"

namespace kinfer::paper2 {

/// The earlier identification, and the one that is measured, by seed.
struct Scenario {
  std::string name;
  std::function<Problem(int seed)> before, now;
};

/// Trials of one method, one a seed.
struct Trials {
  Method method{};
  std::vector<Trial> list;
};

std::vector<Trials> compare(const Scenario& scenario, const std::vector<Method>& methods, int seeds,
                            const Effort& effort, int threads);

/// Hit rate, iterations, evaluations, time, held-out errors; medians over seeds, a miss counting as infinite.
TextTable comparison_table(const std::vector<Trials>& trials);

/// Median of iterations over seeds, a miss counting as infinite (−1).
double median_iterations(const Trials& trials);
int hits_within(const Trials& trials, int iterations);

}  // namespace kinfer::paper2
