// SPDX-License-Identifier: Apache-2.0
// Biases that the filter keeps far from where they were handed over: a sensor that changed, or one that stands for a
// neighbour that turned.
#pragma once

#include <optional>
#include <vector>

#include "kinfer/track/filter/chain_filter.hpp"

namespace kinfer::track {

class BiasWatch {
 public:
  explicit BiasWatch(std::size_t sensors) : biases_(sensors) {}

  void reset();

  /// After each update of the filter. Where something else is named already (`is_explained`), biases follow from that.
  void add(const ChainFilter& filter, bool is_explained, double time);

  /// [s] Of a sensor whose biases have been far off for so long that it is an alarm.
  std::optional<double> named_since(std::size_t sensor) const;
  bool names_any() const;
  /// Something else may explain them: none is named by this update.
  void withhold();

 private:
  struct BiasChange {
    std::optional<double> since{};  // [s] far off
    bool is_named = false;
  };
  std::vector<BiasChange> biases_;  // of each sensor
};

/// How far a sensor's biases are from those handed over, over what is far.
double bias_strength(const ChainFilter& filter, std::size_t sensor);

}  // namespace kinfer::track
