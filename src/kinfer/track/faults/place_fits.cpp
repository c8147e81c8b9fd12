// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/faults/place_fits.hpp"

#include <algorithm>

namespace kinfer::track {

void PlaceFits::add(const StartGrid& grid, double time, double length) {
  for (const StartGrid::Candidate& candidate : grid.candidates()) {
    if (candidate.place >= fits_.size()) fits_.resize(candidate.place + 1, untold_);
    fits_[candidate.place].add(candidate.filter, time, length);
  }
}

Suspect PlaceFits::common(const StartGrid& grid) const {
  const auto worst = [&](const StartGrid::Candidate& c) { return fits_[c.place].worst(c.filter); };
  const std::span<const StartGrid::Candidate> candidates = grid.candidates();
  const Suspect first = worst(candidates.front());
  const bool is_common = std::ranges::all_of(candidates, [&](const auto& c) { return worst(c) == first; });
  return is_common ? first : Suspect{};
}

}  // namespace kinfer::track
