// SPDX-License-Identifier: Apache-2.0
#include "kinfer/search/swarm/objective.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/expect.hpp"
#include "kinfer/base/parallel.hpp"

namespace kinfer {
namespace {

// Candidates per block; fixed, so that the arithmetic does not depend on the number of threads, and a multiple of any
// number of lanes.
constexpr Eigen::Index block = 32;

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

MatrixXd uniform_swarm(const Bounds& bounds, int n, Rng rng) {
  MatrixXd swarm(bounds.size(), n);
  for (int p = 0; p < n; ++p) {
    Rng draw = rng.stream(p);
    for (Eigen::Index d = 0; d < swarm.rows(); ++d) swarm(d, p) = draw.uniform(bounds.lower[d], bounds.upper[d]);
  }
  return swarm;
}

std::vector<double> BatchEvaluator::operator()(const MatrixXd& x) {
  KINFER_EXPECT(x.rows() == objective_.bounds.size(), "{} numbers in a box of {}", x.rows(), objective_.bounds.size());
  std::vector<double> cost(x.cols());
  const auto blocks = static_cast<std::size_t>((x.cols() + block - 1) / block);
  parallel_for(blocks, threads_, [&](std::size_t b) {
    const Eigen::Index first = static_cast<Eigen::Index>(b) * block, count = std::min(block, x.cols() - first);
    objective_.evaluate(x.middleCols(first, count), std::span(cost).subspan(first, count));
  });
  evaluations_ += x.cols();
  for (double& value : cost) {
    if (std::isfinite(value)) continue;
    value = std::numeric_limits<double>::infinity();
    ++not_finite_;
  }
  return cost;
}

bool SearchHistory::add(const MatrixXd& x, const std::vector<double>& cost) {
  const auto lowest = std::min_element(cost.begin(), cost.end());
  if (outcome_.x.size() == 0 || *lowest < outcome_.cost) {
    outcome_.cost = *lowest;
    outcome_.x = x.col(lowest - cost.begin());
  }
  if (populations_ == 0) outcome_.initial_swarm = x;
  outcome_.iterations = populations_++;
  outcome_.best.push_back(outcome_.cost);
  outcome_.median.push_back(median_of(cost));

  const Progress progress{
      .stage = "search",
      .fraction = budget_.max_iterations > 0 ? double(outcome_.iterations) / budget_.max_iterations : 1,
      .best = outcome_.cost,
      .median = outcome_.median.back(),
      .iteration = outcome_.iterations,
      .detail = {}};
  if (outcome_.cost <= budget_.target_cost) {
    outcome_.stop = Stop::target_reached;
  } else if (notify(observer_, progress) == ObserverDecision::stop) {
    outcome_.stop = Stop::cancelled;
  } else if (is_stagnant()) {
    outcome_.stop = Stop::converged_cost;
  } else if (outcome_.iterations < budget_.max_iterations) {
    return false;
  } else {
    outcome_.stop = std::isfinite(outcome_.cost) ? Stop::budget_spent : Stop::not_finite;
  }
  return true;
}

bool SearchHistory::is_stagnant() const {
  constexpr double min_improvement = 0.01;  // of the cost
  if (budget_.patience <= 0 || outcome_.iterations < budget_.patience) return false;
  const double before = outcome_.best[outcome_.best.size() - 1 - budget_.patience];
  return std::isfinite(before) && outcome_.cost >= (1.0 - min_improvement) * before;
}

SearchOutcome SearchHistory::finish(const BatchEvaluator& evaluator, MatrixXd final_swarm) {
  outcome_.evaluations = evaluator.evaluations();
  outcome_.not_finite = evaluator.not_finite();
  outcome_.final_swarm = std::move(final_swarm);
  return std::move(outcome_);
}

void PersonalBests::update(const MatrixXd& now, const std::vector<double>& now_cost) {
  if (x.size() == 0) {
    x = now;
    cost = now_cost;
    return;
  }
  for (std::size_t p = 0; p < now_cost.size(); ++p) {
    if (now_cost[p] >= cost[p]) continue;
    cost[p] = now_cost[p];
    x.col(static_cast<Eigen::Index>(p)) = now.col(static_cast<Eigen::Index>(p));
  }
}

}  // namespace kinfer
