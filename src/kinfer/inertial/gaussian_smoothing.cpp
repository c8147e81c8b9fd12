// SPDX-License-Identifier: Apache-2.0
#include "kinfer/inertial/gaussian_smoothing.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/expect.hpp"

namespace kinfer {
namespace {

constexpr double min_width = 1.2;     // [periods] a narrower kernel would alias above half the sampling rate
constexpr double kernel_reach = 4.5;  // [sigma] where the Gaussian has decayed to 4e-5

std::vector<double> convolved(std::span<const double> signal, std::span<const double> weights, int half) {
  const auto n = static_cast<int>(signal.size());
  std::vector<double> result(signal.size());
  for (int i = 0; i < n; ++i) {
    double sum = 0.0;
    for (int k = -half; k <= half; ++k)
      sum +=
          weights[static_cast<std::size_t>(k + half)] * signal[static_cast<std::size_t>(std::clamp(i + k, 0, n - 1))];
    result[static_cast<std::size_t>(i)] = sum;
  }
  return result;
}

}  // namespace

GaussianKernel gaussian_kernel(double sigma, double period) {
  KINFER_EXPECT(sigma >= 0.0 && period > 0.0, "sigma {}, period {}", sigma, period);
  const double width = std::max(sigma / period, min_width);
  GaussianKernel kernel{.half = static_cast<int>(std::ceil(kernel_reach * width)), .smooth = {}, .derivative = {}};
  double sum = 0.0, slope = 0.0;
  for (int k = -kernel.half; k <= kernel.half; ++k) {
    const double g = std::exp(-0.5 * k * k / (width * width));
    kernel.smooth.push_back(g);
    kernel.derivative.push_back(k * g);
    sum += g;
    slope += k * g * k;
  }
  for (double& weight : kernel.smooth) weight /= sum;
  for (double& weight : kernel.derivative) weight /= slope * period;
  return kernel;
}

std::vector<double> smoothed(std::span<const double> signal, const GaussianKernel& kernel) {
  return convolved(signal, kernel.smooth, kernel.half);
}

std::vector<double> smoothed_derivative(std::span<const double> signal, const GaussianKernel& kernel) {
  return convolved(signal, kernel.derivative, kernel.half);
}

}  // namespace kinfer
