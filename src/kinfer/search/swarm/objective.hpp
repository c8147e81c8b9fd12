// SPDX-License-Identifier: Apache-2.0
// Problem and result of population searches: a cost over a box, evaluated in batches.
//
// Types are erased per batch, so that this costs nothing per candidate.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "kinfer/base/observer.hpp"
#include "kinfer/base/rng.hpp"
#include "kinfer/base/stop.hpp"
#include "kinfer/linalg/types.hpp"
#include "kinfer/search/swarm/mlp.hpp"

namespace kinfer {

/// A cost over a box. `evaluate` is called from several threads at once and must not keep state between calls.
struct Objective {
  Bounds bounds;
  std::function<void(ConstMatrixRef x /* dim x n, one candidate per column */, std::span<double> cost /* n */)>
      evaluate{};
};

/// Termination criteria of a search, and how many threads it may use.
struct Budget {
  int max_iterations = 1000;  ///< updates of the population; 0: only the initial one is evaluated
  int patience = 0;           ///< ends when so many updates lower the best cost by less than 1 %; 0: never
  double target_cost = -std::numeric_limits<double>::infinity();  ///< ends when the best cost is not above it
  int threads = 0;                                                ///< 0: all cores; the result does not depend on it
};

/// Result of a search, and data for a warm start of the next one.
struct SearchOutcome {
  VectorXd x{};                                           ///< best point
  double cost = std::numeric_limits<double>::infinity();  ///< at x
  std::vector<double> best{};    ///< lowest cost so far: of the initial population, then after each iteration
  std::vector<double> median{};  ///< median cost of the population, likewise
  Stop stop = Stop::budget_spent;
  int iterations = 0;         ///< updates of the population
  long long evaluations = 0;  ///< candidates evaluated
  long long not_finite = 0;   ///< those of them whose cost was not finite; it counts as infinite
  MatrixXd initial_swarm{};   ///< dim x n, evaluated first
  MatrixXd final_swarm{};     ///< dim x n, evaluated last
  std::optional<Mlp> net{};   ///< of BPNN-PSO: trained on this run, for the next one
};

/// n points drawn uniformly from the box, one per column; column p from `rng.stream(p)`.
MatrixXd uniform_swarm(const Bounds& bounds, int n, Rng rng);

/// Evaluates candidates in blocks of fixed size on several threads, and counts evaluations.
class BatchEvaluator {
 public:
  BatchEvaluator(const Objective& objective, int threads) : objective_(objective), threads_(threads) {}

  /// Cost of each column of x; a non-finite cost counts as infinite.
  std::vector<double> operator()(const MatrixXd& x);

  long long evaluations() const { return evaluations_; }
  long long not_finite() const { return not_finite_; }

 private:
  const Objective& objective_;
  int threads_;
  long long evaluations_ = 0, not_finite_ = 0;
};

/// Best point so far, history and termination: the bookkeeping of every population search.
class SearchHistory {
 public:
  SearchHistory(const Budget& budget, const Observer& observer) : budget_(budget), observer_(observer) {}

  /// Records one evaluated population; true if the search has to end.
  bool add(const MatrixXd& x, const std::vector<double>& cost);

  const VectorXd& best() const { return outcome_.x; }

  /// The outcome, with the evaluation counts and the population evaluated last.
  SearchOutcome finish(const BatchEvaluator& evaluator, MatrixXd final_swarm);

 private:
  bool is_stagnant() const;

  const Budget& budget_;
  const Observer& observer_;
  SearchOutcome outcome_;
  int populations_ = 0;
};

/// Each particle's own best point so far.
struct PersonalBests {
  MatrixXd x;                ///< dim x n
  std::vector<double> cost;  ///< n

  void update(const MatrixXd& now, const std::vector<double>& now_cost);
};

}  // namespace kinfer
