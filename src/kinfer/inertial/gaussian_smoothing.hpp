// SPDX-License-Identifier: Apache-2.0
// A signal and its derivative with the same smoothing: convolution with a Gaussian and with its derivative.
//
// Their transfer functions are G(ω) and iω G(ω), so a smoothed acceleration and an angular acceleration derived from a
// smoothed rate are attenuated equally. Differencing after smoothing, or smoothing only one of them, biases the lever
// arms (docs/development/methods/paper1.md).
#pragma once

#include <span>
#include <vector>

namespace kinfer {

/// Weights of the samples −half .. half.
struct GaussianKernel {
  int half = 0;
  std::vector<double> smooth;      ///< sums to 1
  std::vector<double> derivative;  ///< [1/s] exact for a straight line
};

/// Standard deviation and sampling period in seconds. Below 1.2 periods the two transfer functions differ, so a
/// narrower kernel is widened to 1.2 periods.
GaussianKernel gaussian_kernel(double sigma, double period);

/// Same length as the signal, which is extended by its first and last value.
std::vector<double> smoothed(std::span<const double> signal, const GaussianKernel& kernel);
std::vector<double> smoothed_derivative(std::span<const double> signal, const GaussianKernel& kernel);

}  // namespace kinfer
