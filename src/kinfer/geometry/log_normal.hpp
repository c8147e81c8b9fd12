// SPDX-License-Identifier: Apache-2.0
// A positive quantity whose logarithm is normal: sizes that are typical within a factor.
#pragma once

#include <cmath>
#include <numbers>

namespace kinfer {

struct LogNormal {
  double median = 1.0, spread = 1.0;  ///< the second: standard deviation of the logarithm
};

/// ln density of ln x.
inline double log_density(double x, const LogNormal& of) {
  const double z = std::log(x / of.median) / of.spread;
  return -0.5 * z * z - std::log(of.spread) - 0.5 * std::log(2.0 * std::numbers::pi);
}

}  // namespace kinfer
