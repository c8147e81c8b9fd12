#include "kinfer/identify/memetic_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>

#include "kinfer/base/parallel.hpp"
#include "kinfer/search/bacterial.hpp"

namespace kinfer {
namespace {

/// Fits each structure once, whoever asks, and counts what that costs.
class FittedStructures {
 public:
  explicit FittedStructures(const MemeticLink& link) : link_(link) {}

  double cost(const LinkStructure& structure) {
    const std::uint32_t key = signature(structure);
    {
      const std::scoped_lock lock(mutex_);
      if (const auto known = fits_.find(key); known != fits_.end()) return cost_of(known->second, structure);
    }
    MemeticFit fit = link_.fit(structure);
    const double value = cost_of(fit, structure);
    const std::scoped_lock lock(mutex_);
    if (fits_.emplace(key, std::move(fit)).second) evaluations_ += fits_.at(key).evaluations;
    return value;
  }

  const MemeticFit& fit(const LinkStructure& structure) const { return fits_.at(signature(structure)); }
  std::int64_t evaluations() const { return evaluations_; }
  std::size_t size() const { return fits_.size(); }

 private:
  double cost_of(const MemeticFit& fit, const LinkStructure& structure) const {
    if (!fit.is_refined) return std::numeric_limits<double>::infinity();
    const double n = std::max(2.0, link_.independent_numbers());
    return fit.j * std::pow(n, 0.5 * number_count(structure) / n);
  }

  const MemeticLink& link_;
  std::map<std::uint32_t, MemeticFit> fits_;
  std::int64_t evaluations_ = 0;
  std::mutex mutex_;
};

constexpr double least_gain = 1e-5;  // of the cost: many structures are the same chain written in another way

/// Costs at points of the spent budget.
struct Course {
  std::vector<double> cost;
  std::vector<std::int64_t> evaluations;
};

std::int64_t evaluations_to(const Course& course, double cost) {
  for (std::size_t i = 0; i < course.cost.size(); ++i)
    if (course.cost[i] <= cost) return course.evaluations[i];
  return course.evaluations.empty() ? 0 : course.evaluations.back();
}

/// Goes to the best neighbour as long as one is better: what evolution may have left out.
void climb(FittedStructures& fits, LinkStructure& best, double& cost, int threads) {
  for (bool is_better = true; is_better;) {
    is_better = false;
    const std::vector<LinkStructure> others = neighbours(best);
    std::vector<double> costs(others.size());
    parallel_for(others.size(), threads, [&](std::size_t i) { costs[i] = fits.cost(others[i]); });
    const auto least = static_cast<std::size_t>(std::ranges::min_element(costs) - costs.begin());
    if (costs[least] < cost * (1.0 - least_gain)) {
      best = others[least];
      cost = costs[least];
      is_better = true;
    }
  }
}

MemeticOutcome outcome_of(const FittedStructures& fits, const LinkStructure& best, double cost) {
  const MemeticFit& fit = fits.fit(best);
  return {.structure = best,
          .leaves = fit.leaves,
          .cost = cost,
          .j = fit.j,
          .evaluations = fits.evaluations(),
          .structures = fits.size(),
          .best_history = {},
          .median_history = {}};
}

MemeticLink link_of(const std::vector<FrameState>& parent, const std::vector<FrameState>& child,
                    std::span<const JointSignal> signals, const std::vector<std::size_t>& rows,
                    const MemeticOptions& options) {
  return {parent, child, signals, evenly_chosen(rows, static_cast<std::size_t>(options.rows)), options.fit};
}

}  // namespace

MemeticOutcome search_memetic(const std::vector<FrameState>& parent, const std::vector<FrameState>& child,
                              std::span<const JointSignal> signals, const std::vector<std::size_t>& rows,
                              const MemeticOptions& options, const Rng& rng, const Observer& observer) {
  const MemeticLink link = link_of(parent, child, signals, rows, options);
  FittedStructures fits(link);
  Course course;
  int idle = 0;
  const Observer watch = [&](const Progress& progress) {
    idle = !course.cost.empty() && !(progress.best < course.cost.back()) ? idle + 1 : 0;
    course.cost.push_back(progress.best);
    course.evaluations.push_back(fits.evaluations());
    return idle >= options.patience ? Wish::stop : tell(observer, progress);
  };
  const auto evolved = evolve_bacteria(
      StructureBreed{}, GenomeCost<LinkStructure>([&](const LinkStructure& s, double) { return fits.cost(s); }),
      options.bacteria, rng, watch);
  LinkStructure best = evolved.best;
  double cost = evolved.cost;
  climb(fits, best, cost, options.bacteria.threads);
  for (LinkStructure other : hinge_structures()) {
    double other_cost = fits.cost(other);
    climb(fits, other, other_cost, options.bacteria.threads);
    if (other_cost < cost) best = other, cost = other_cost;
  }
  course.cost.push_back(cost);
  course.evaluations.push_back(fits.evaluations());
  MemeticOutcome outcome = outcome_of(fits, best, cost);
  outcome.evaluations_to_1 = evaluations_to(course, 1.01 * cost);
  outcome.generations = evolved.generations;
  outcome.best_history = evolved.best_history;
  outcome.best_history.push_back(cost);
  outcome.median_history = evolved.median_history;
  outcome.median_history.push_back(evolved.median_history.back());
  return outcome;
}

MemeticOutcome search_all(const std::vector<FrameState>& parent, const std::vector<FrameState>& child,
                          std::span<const JointSignal> signals, const std::vector<std::size_t>& rows,
                          const MemeticOptions& options) {
  const MemeticLink link = link_of(parent, child, signals, rows, options);
  FittedStructures fits(link);
  const std::vector<LinkStructure> structures = all_structures(most_leaves);
  std::vector<double> costs(structures.size());
  parallel_for(structures.size(), options.bacteria.threads,
               [&](std::size_t i) { costs[i] = fits.cost(structures[i]); });
  const auto least = static_cast<std::size_t>(std::ranges::min_element(costs) - costs.begin());
  MemeticOutcome outcome = outcome_of(fits, structures[least], costs[least]);
  outcome.best_history = {costs[least]};
  outcome.median_history = {costs[least]};
  return outcome;
}

}  // namespace kinfer
