// SPDX-License-Identifier: Apache-2.0
#include "kinfer/inertial/gaussian_smoothing.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace kinfer {
namespace {

constexpr double period = 0.005, sigma = 0.02;

TEST(GaussianSmoothing, KeepsConstantsAndStraightLinesAndDerivesThemExactly) {
  const GaussianKernel kernel = gaussian_kernel(sigma, period);
  std::vector<double> line;
  for (int i = 0; i < 200; ++i) line.push_back(3.0 - 2.0 * period * i);
  EXPECT_NEAR(smoothed(line, kernel)[100], line[100], 1e-12);
  EXPECT_NEAR(smoothed_derivative(line, kernel)[100], -2.0, 1e-12);
}

TEST(GaussianSmoothing, DampsASineAndItsDerivativeAlike) {
  const GaussianKernel kernel = gaussian_kernel(sigma, period);
  for (const double frequency : {0.5, 2.0, 6.0}) {
    const double w = 2.0 * 3.14159265358979323846 * frequency, damping = std::exp(-0.5 * w * w * sigma * sigma);
    std::vector<double> sine;
    for (int i = 0; i < 2000; ++i) sine.push_back(std::sin(w * period * i));
    for (const std::size_t i : {500u, 777u}) {
      EXPECT_NEAR(smoothed(sine, kernel)[i], damping * sine[i], 1e-4);
      EXPECT_NEAR(smoothed_derivative(sine, kernel)[i], damping * w * std::cos(w * period * static_cast<double>(i)),
                  2e-4 * w);
    }
  }
}

TEST(GaussianSmoothing, DampsBothAlikeAtASlowSamplingRateToo) {
  const double slow = 0.025, widened = 1.2 * slow, w = 2.0 * 3.14159265358979323846 * 8.0;
  const GaussianKernel kernel = gaussian_kernel(sigma, slow);
  std::vector<double> sine;
  for (int i = 0; i < 400; ++i) sine.push_back(std::sin(w * slow * i));
  const double damping = std::exp(-0.5 * w * w * widened * widened);
  for (const std::size_t i : {101u, 203u}) {
    EXPECT_NEAR(smoothed(sine, kernel)[i], damping * sine[i], 0.002);
    EXPECT_NEAR(smoothed_derivative(sine, kernel)[i], damping * w * std::cos(w * slow * static_cast<double>(i)),
                0.01 * damping * w);
  }
}

}  // namespace
}  // namespace kinfer
