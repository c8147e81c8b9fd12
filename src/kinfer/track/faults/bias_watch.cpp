// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/faults/bias_watch.hpp"

#include <algorithm>

#include "kinfer/track/faults/thresholds.hpp"

namespace kinfer::track {
namespace {

double bias_distance(const ChainFilter& filter, std::size_t sensor) {
  const InsLevel distance = filter.bias_distance(sensor);
  return std::max(distance.rate, distance.force);
}

}  // namespace

void BiasWatch::reset() {
  std::ranges::fill(biases_, BiasChange{});
}

void BiasWatch::add(const ChainFilter& filter, bool is_explained, double time) {
  for (std::size_t s = 0; s < biases_.size(); ++s) {
    BiasChange& bias = biases_[s];
    if (bias_distance(filter, s) < (bias.is_named ? bias_recovered : bias_limit))
      bias = {};
    else if (!bias.since)
      bias.since = time;
    bias.is_named |= bias.since && !is_explained && time - *bias.since > settling;
  }
}

void BiasWatch::withhold() {
  for (BiasChange& bias : biases_) bias.is_named = false;
}

std::optional<double> BiasWatch::named_since(std::size_t sensor) const {
  return biases_[sensor].is_named ? biases_[sensor].since : std::nullopt;
}

bool BiasWatch::names_any() const {
  return std::ranges::any_of(biases_, &BiasChange::is_named);
}

double bias_strength(const ChainFilter& filter, std::size_t sensor) {
  return bias_distance(filter, sensor) / bias_limit;
}

}  // namespace kinfer::track
