// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/start/start_grid.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinfer/track/start/thresholds.hpp"

namespace kinfer::track {

void StartGrid::add_place(const ChainFilter& filter, double value, double sd, int steps_away) {
  candidates_.push_back({filter, 0.0, steps_away});
  candidates_.back().filter.place(position_, value, sd);
}

StartGrid StartGrid::around(const ChainFilter& filter, Index position) {
  StartGrid grid(position, true);
  const double q = filter.state().joints[position_states * position], step = 2.0 * std::numbers::pi / start_places;
  for (int k = 0; k < start_places; ++k)
    grid.add_place(filter, q + std::remainder(k * step, 2.0 * std::numbers::pi), 0.5 * step,
                   std::min(k, start_places - k));
  return grid;
}

StartGrid StartGrid::along(const ChainFilter& filter, Index position, const PositionGuess& guess) {
  StartGrid grid(position, false);
  const double step = std::max(prismatic_step, 2.0 * guess.sd / (start_places - 1));
  const int places = 1 + static_cast<int>(2.0 * guess.sd / step);
  for (int k = 0; k < places; ++k)
    grid.add_place(filter, guess.value - guess.sd + k * step, 0.5 * step, std::abs(2 * k - places + 1) / 2);
  return grid;
}

const ChainFilter& StartGrid::best() const {
  return std::ranges::min_element(candidates_, {}, &Candidate::steps_away)->filter;
}

void StartGrid::update(const BlockMeasurement& block) {
  for (Candidate& candidate : candidates_) {
    candidate.filter.predict(block.time);
    candidate.filter.update(block);
    if (updates_ >= start_updates) candidate.log_weight += candidate.filter.innovations().log_likelihood;
  }
  if (++updates_ <= start_updates) return;
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
  const auto distance = [&](const Candidate& a, const Candidate& b) {
    const double d =
        a.filter.state().joints[position_states * position_] - b.filter.state().joints[position_states * position_];
    return std::abs(is_angle_ ? std::remainder(d, 2.0 * std::numbers::pi) : d);
  };
  for (std::size_t i = 0; i < candidates_.size(); ++i)
    for (std::size_t j = candidates_.size() - 1; j > i; --j)
      if (distance(candidates_[i], candidates_[j]) < start_merge)
        candidates_.erase(candidates_.begin() + static_cast<std::ptrdiff_t>(j));
}

}  // namespace kinfer::track
