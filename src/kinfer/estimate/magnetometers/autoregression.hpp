// SPDX-License-Identifier: Apache-2.0
// Noise of a magnetometer with its disturbances: an autoregressive process with heavy tails,
//   r_t = Σ φ_j r_{t−j} + e_t,  e_t ~ Student t.
// Moving steel disturbs the field slowly, so neighbouring residuals are alike: the process gives each as many effective
// samples as it is worth at the frequencies of the motion, and the tails give transients little weight.
#pragma once

#include <array>
#include <vector>

#include "kinfer/geometry/rotation.hpp"

namespace kinfer {

inline constexpr std::size_t autoregressive_order = 4;

struct AutoregressiveNoise {
  std::array<double, autoregressive_order> coefficients{};  ///< φ
  double sd = 1.0;                                          ///< scale of e, of each axis
  double efficiency = 1.0;     ///< information of a time over weight / sd²: what the robust weights cost or pretend
  std::vector<double> weight;  ///< of each time, 0 where it or one of those before it is missing
};

/// From residuals about a model, at regular times.
AutoregressiveNoise estimate_noise(const std::vector<Vec3>& residual, const std::vector<bool>& is_valid);

/// e_t of a series at `at` ≥ autoregressive_order; `value(t)` is any vector or matrix.
template <class Value>
auto innovation(const AutoregressiveNoise& noise, std::size_t at, const Value& value) {
  auto e = value(at);
  for (std::size_t j = 0; j < autoregressive_order; ++j) e -= noise.coefficients[j] * value(at - j - 1);
  return e;
}

}  // namespace kinfer
