// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/programming/memetic_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>

#include "kinfer/base/parallel.hpp"
#include "kinfer/identify/programming/thresholds.hpp"
#include "kinfer/search/evolution/bacterial_programming.hpp"

namespace kinfer::identify {
namespace {

/// Cache for several threads: fits each structure once and counts the evaluations.
class StructureFitCache {
 public:
  explicit StructureFitCache(const StructureFitter& link) : link_(link) {}

  double cost(const LinkStructure& structure) {
    const std::uint32_t key = signature(structure);
    {
      const std::scoped_lock lock(mutex_);
      if (const auto known = fits_.find(key); known != fits_.end()) return cost_of(known->second, structure);
    }
    StructureFit fit = link_.fit(structure);
    const double value = cost_of(fit, structure);
    const std::scoped_lock lock(mutex_);
    if (fits_.emplace(key, std::move(fit)).second) evaluations_ += fits_.at(key).evaluations;
    return value;
  }

  const StructureFit& fit(const LinkStructure& structure) const { return fits_.at(signature(structure)); }
  std::int64_t evaluations() const { return evaluations_; }
  std::size_t size() const { return fits_.size(); }

 private:
  double cost_of(const StructureFit& fit, const LinkStructure& structure) const {
    if (!fit.is_refined) return std::numeric_limits<double>::infinity();
    const double n = std::max(2.0, link_.effective_sample_count());
    return fit.j * std::pow(n, 0.5 * parameter_count(structure) / n);
  }

  const StructureFitter& link_;
  std::map<std::uint32_t, StructureFit> fits_;
  std::int64_t evaluations_ = 0;
  std::mutex mutex_;
};

/// Best cost against the number of evaluations.
struct CostHistory {
  std::vector<double> cost;
  std::vector<std::int64_t> evaluations;
};

std::int64_t evaluations_to(const CostHistory& history, double cost) {
  for (std::size_t i = 0; i < history.cost.size(); ++i)
    if (history.cost[i] <= cost) return history.evaluations[i];
  return history.evaluations.empty() ? 0 : history.evaluations.back();
}

/// Local search: moves to the best neighbour as long as it is better. Covers what evolution may have missed.
void search_neighbours(StructureFitCache& fits, LinkStructure& best, double& cost, int threads) {
  for (bool is_better = true; is_better;) {
    is_better = false;
    const std::vector<LinkStructure> others = neighbour_structures(best);
    std::vector<double> costs(others.size());
    parallel_for(others.size(), threads, [&](std::size_t i) { costs[i] = fits.cost(others[i]); });
    const auto least = static_cast<std::size_t>(std::ranges::min_element(costs) - costs.begin());
    if (costs[least] < cost * (1.0 - min_structure_gain)) {
      best = others[least];
      cost = costs[least];
      is_better = true;
    }
  }
}

StructureSearchOutcome outcome_of(const StructureFitCache& fits, const LinkStructure& best, double cost) {
  const StructureFit& fit = fits.fit(best);
  return {.structure = best,
          .leaves = fit.leaves,
          .cost = cost,
          .j = fit.j,
          .evaluations = fits.evaluations(),
          .structures = fits.size(),
          .best_history = {},
          .median_history = {}};
}

StructureFitter make_fitter(const std::vector<FrameState>& parent, const std::vector<FrameState>& child,
                            std::span<const JointSignal> signals, const std::vector<std::size_t>& rows, int count) {
  return {parent, child, signals, thin_rows(rows, static_cast<std::size_t>(count)), {}};
}

}  // namespace

StructureSearchOutcome search_memetic(const std::vector<FrameState>& parent, const std::vector<FrameState>& child,
                                      std::span<const JointSignal> signals, const std::vector<std::size_t>& rows,
                                      const MemeticProgramming& options, const Rng& rng, const Observer& observer) {
  const StructureFitter link = make_fitter(parent, child, signals, rows, options.rows);
  StructureFitCache fits(link);
  CostHistory history;
  int stalled_generations = 0;
  const Observer watch = [&](const Progress& progress) {
    stalled_generations = !history.cost.empty() && !(progress.best < history.cost.back()) ? stalled_generations + 1 : 0;
    history.cost.push_back(progress.best);
    history.evaluations.push_back(fits.evaluations());
    return stalled_generations >= patience ? ObserverDecision::stop : notify(observer, progress);
  };
  const auto evolved = evolve_bacteria(
      StructureOperators{}, GenomeCost<LinkStructure>([&](const LinkStructure& s, double) { return fits.cost(s); }),
      options.bacteria, rng, watch);
  LinkStructure best = evolved.best;
  double cost = evolved.cost;
  search_neighbours(fits, best, cost, options.bacteria.threads);
  for (LinkStructure other : revolute_structures()) {
    double other_cost = fits.cost(other);
    search_neighbours(fits, other, other_cost, options.bacteria.threads);
    if (other_cost < cost) best = other, cost = other_cost;
  }
  history.cost.push_back(cost);
  history.evaluations.push_back(fits.evaluations());
  StructureSearchOutcome outcome = outcome_of(fits, best, cost);
  outcome.evaluations_to_1_percent = evaluations_to(history, 1.01 * cost);
  outcome.generations = evolved.generations;
  outcome.best_history = evolved.best_history;
  outcome.best_history.push_back(cost);
  outcome.median_history = evolved.median_history;
  outcome.median_history.push_back(evolved.median_history.back());
  return outcome;
}

StructureSearchOutcome search_exhaustive(const std::vector<FrameState>& parent, const std::vector<FrameState>& child,
                                         std::span<const JointSignal> signals, const std::vector<std::size_t>& rows,
                                         const Enumeration& options, int threads, const Observer& observer) {
  constexpr std::size_t block = 64;  // between two notifications
  const StructureFitter link = make_fitter(parent, child, signals, rows, options.rows);
  StructureFitCache fits(link);
  const std::vector<LinkStructure> structures = enumerate_structures(max_structure_leaves);
  std::vector<double> costs;
  std::size_t least = 0;
  for (bool is_wanted = true; is_wanted && costs.size() < structures.size();) {
    const std::size_t first = costs.size();
    costs.resize(std::min(first + block, structures.size()));
    parallel_for(costs.size() - first, threads,
                 [&](std::size_t i) { costs[first + i] = fits.cost(structures[first + i]); });
    least = static_cast<std::size_t>(std::ranges::min_element(costs) - costs.begin());
    const double fraction = static_cast<double>(costs.size()) / static_cast<double>(structures.size());
    is_wanted = notify(observer, {.stage = "search", .fraction = fraction, .best = costs[least], .detail = {}}) ==
                ObserverDecision::proceed;
  }
  StructureSearchOutcome outcome = outcome_of(fits, structures[least], costs[least]);
  outcome.best_history = {costs[least]};
  outcome.median_history = {costs[least]};
  return outcome;
}

}  // namespace kinfer::identify
