// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/filter/instrument_levels.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "kinfer/track/model/thresholds.hpp"

namespace kinfer::track {
namespace {

/// Of an even number the lower of the middle two; reorders.
double lower_median(std::span<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

void InstrumentLevels::adapt(const Innovations& innovations, const std::vector<bool>& is_measured,
                             const std::vector<bool>& is_used) {
  const std::vector<double>& excess = innovations.of_instrument;
  for (std::size_t half = 0; half < 2; ++half) {
    std::size_t count = 0;
    for (std::size_t i = half; i < is_measured.size(); i += 2)
      if (is_measured[i]) ordered_[count++] = excess[i];
    if (count == 0) continue;
    const double middle = lower_median({ordered_.data(), count});
    const double fastest = std::min(outlier_limit / 3.0, lone_inflation * std::max(1.0, middle));
    for (std::size_t i = half; i < is_measured.size(); i += 2) {
      if (!is_measured[i]) continue;
      double& factor = half == 0 ? factor_[i / 2].rate : factor_[i / 2].force;
      factor = std::clamp(factor * std::exp(inflation_gain * (std::min(excess[i], fastest) - 1.0)), 1.0, max_inflation);
    }
  }
  std::size_t used = 0;
  for (std::size_t s = 0; s < is_used.size(); ++s)
    if (is_used[s]) ordered_[used++] = std::max(factor_[s].rate, factor_[s].force);
  if (used > 0) common_ = lower_median({ordered_.data(), used});
}

}  // namespace kinfer::track
