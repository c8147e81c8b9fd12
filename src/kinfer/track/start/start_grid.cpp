// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/start/start_grid.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinfer/track/start/thresholds.hpp"

namespace kinfer::track {

StartGrid::StartGrid(const ChainFilter& filter, Index position) : position_(position) {
  const double q = filter.state().joints[position_states * position], step = 2.0 * std::numbers::pi / start_places;
  for (int k = 0; k < start_places; ++k) {
    candidates_.push_back({filter});
    candidates_.back().filter.place(position, q + std::remainder(k * step, 2.0 * std::numbers::pi), 0.5 * step);
  }
}

const ChainFilter& StartGrid::best() const {
  return std::ranges::max_element(candidates_, {}, &Candidate::log_weight)->filter;
}

void StartGrid::update(const BlockMeasurement& block) {
  for (Candidate& candidate : candidates_) {
    candidate.filter.predict(block.time);
    candidate.filter.update(block);
    candidate.log_weight += candidate.filter.innovations().log_likelihood;
  }
  drop_unlikely();
  merge();
}

void StartGrid::drop_unlikely() {
  const double most = std::ranges::max_element(candidates_, {}, &Candidate::log_weight)->log_weight;
  std::erase_if(candidates_, [&](const Candidate& c) { return c.log_weight < most - start_log_odds; });
}

/// Candidates that have converged to one place are one.
void StartGrid::merge() {
  std::ranges::stable_sort(candidates_, std::greater<>{}, &Candidate::log_weight);
  const auto at = [&](const Candidate& c) { return c.filter.state().joints[position_states * position_]; };
  for (std::size_t i = 0; i < candidates_.size(); ++i)
    for (std::size_t j = candidates_.size() - 1; j > i; --j)
      if (std::abs(std::remainder(at(candidates_[i]) - at(candidates_[j]), 2.0 * std::numbers::pi)) < start_merge)
        candidates_.erase(candidates_.begin() + static_cast<std::ptrdiff_t>(j));
}

}  // namespace kinfer::track
