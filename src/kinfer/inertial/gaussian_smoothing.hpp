// A signal and its derivative through the same smoothing: convolution with a Gaussian and with the Gaussian's
// derivative.
//
// Their transfer functions are G(ω) and iω G(ω), so a smoothed acceleration and an angular acceleration taken from a
// smoothed rate are damped alike. Differencing after smoothing, or smoothing only one of them, makes levers too long or
// too short (docs/methods/paper1.md).
#pragma once

#include <span>
#include <vector>

namespace kinfer {

/// Weights of the samples at −half .. half.
struct GaussianKernel {
  int half = 0;
  std::vector<double> smooth;      ///< sums to 1
  std::vector<double> derivative;  ///< [1/s] gives the derivative of a straight line exactly
};

/// Standard deviation and sampling period in seconds. Narrower than 1.2 periods the two transfer functions part: it is
/// widened to that.
GaussianKernel gaussian_kernel(double sigma, double period);

/// Same length as the signal; at its ends the signal is continued by its first and last value.
std::vector<double> smoothed(std::span<const double> signal, const GaussianKernel& kernel);
std::vector<double> smoothed_derivative(std::span<const double> signal, const GaussianKernel& kernel);

}  // namespace kinfer
