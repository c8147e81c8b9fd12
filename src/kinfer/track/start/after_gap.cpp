// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/start/after_gap.hpp"

#include <algorithm>
#include <cmath>

namespace kinfer::track {

PositionAfterGap after_gap(const LastPosition& last, double time, double rate) {
  const double gap = time - last.time, by_rates = last.acceleration_sd * gap * gap / 8.0,
               at_most = std::min(last.speed * gap, last.most_turned);
  return {.value = last.value + 0.5 * (last.rate + rate) * gap, .sd = std::hypot(last.sd, std::min(by_rates, at_most))};
}

}  // namespace kinfer::track
