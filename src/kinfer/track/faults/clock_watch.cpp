// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/faults/clock_watch.hpp"

#include <cmath>

#include "kinfer/track/faults/thresholds.hpp"

namespace kinfer::track {

void ClockWatch::add(const ChainFilter& filter, double length) {
  const Innovations& innovations = filter.innovations();
  const double kept = std::exp(-length / clock_mean);
  for (std::size_t s = 0; s < clocks_.size(); ++s) {
    if (innovations.rows[s] == 0) continue;
    Clock& clock = clocks_[s];
    const LatenessScore& late = innovations.lateness[s];
    clock.score = kept * clock.score + late.score;
    clock.information = kept * clock.information + late.information;
    clock.excess = kept * clock.excess + innovations.unlimited[s] - innovations.rows[s];
  }
}

bool ClockWatch::is_late(std::size_t sensor, double share) const {
  const Clock& clock = clocks_[sensor];
  if (clock.information <= 0.0 || std::abs(lateness(sensor)) < least_lateness) return false;
  const double explained = clock.score * clock.score / clock.information;
  return explained > lateness_evidence && explained > share * clock.excess;
}

}  // namespace kinfer::track
