// First-order low pass whose first seconds are a plain mean: it has no start-up transient to wait for.
#pragma once

#include <algorithm>

namespace kinfer {

template <class Value>
struct LowPass {
  Value value{};
  double age = 0.0;  ///< [s] since the first number

  /// Takes a number that stands for `dt` seconds; `time_constant` in seconds. First-order hold of 1 - exp(-dt/tau).
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
