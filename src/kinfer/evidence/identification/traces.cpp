// SPDX-License-Identifier: Apache-2.0
#include "kinfer/evidence/identification/traces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinfer/base/expect.hpp"

namespace kinfer {

Binning binning(std::size_t samples, std::size_t max_bins) {
  KINFER_EXPECT(max_bins > 0, "no bins for {} samples", samples);
  return {samples, std::max<std::size_t>(1, (samples + max_bins - 1) / max_bins)};
}

Envelope envelope(std::span<const double> samples, const Binning& bins) {
  KINFER_EXPECT(samples.size() == bins.samples, "{} samples, bins for {}", samples.size(), bins.samples);
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  Envelope result{std::vector<double>(bins.count(), none), std::vector<double>(bins.count(), none)};
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!std::isfinite(samples[i])) continue;
    double &low = result.low[i / bins.size], &high = result.high[i / bins.size];
    low = std::isnan(low) ? samples[i] : std::min(low, samples[i]);
    high = std::isnan(high) ? samples[i] : std::max(high, samples[i]);
  }
  return result;
}

std::string_view name(TraceQuantity quantity) {
  return quantity == TraceQuantity::acceleration ? "acceleration" : "rate";
}

std::string_view unit(TraceQuantity quantity) {
  return quantity == TraceQuantity::acceleration ? "m/s^2" : "rad/s";
}

std::string_view name(TraceFrame frame) {
  return frame == TraceFrame::world ? "ground" : "sensor";
}

}  // namespace kinfer
