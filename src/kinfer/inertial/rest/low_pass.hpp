// SPDX-License-Identifier: Apache-2.0
// First-order low pass that starts as a cumulative mean and so has no start-up transient.
#pragma once

#include <algorithm>

namespace kinfer {

template <class Value>
struct LowPass {
  Value value{};
  double age = 0.0;  ///< [s] since the first value

  /// Adds a value that covers `dt` [s]; `time_constant` in [s]. The gain approximates 1 - exp(-dt/tau).
  void add(const Value& next, double dt, double time_constant) {
    age += dt;
    const double gain = std::max(dt / (time_constant + dt), dt / age);
    if (age <= dt)
      value = next;
    else
      value += gain * (next - value);
  }
};

}  // namespace kinfer
