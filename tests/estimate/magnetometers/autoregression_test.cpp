// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/magnetometers/autoregression.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kinfer/base/rng.hpp"
#include "support/random.hpp"

namespace kinfer {
namespace {

/// First-order process with white innovations of standard deviation 0.3.
std::vector<Vec3> process(double coefficient, std::size_t count, std::uint64_t seed = 3) {
  Rng rng(seed);
  std::vector<Vec3> series{Vec3::Zero()};
  while (series.size() < count) series.push_back(coefficient * series.back() + 0.3 * test::random_vector(rng));
  return series;
}

double sum(const AutoregressiveNoise& noise) {
  double all = 0.0;
  for (const double c : noise.coefficients) all += c;
  return all;
}

/// Information of one sample about a constant, as it is used.
double information_about_level(const AutoregressiveNoise& noise) {
  return noise.efficiency * std::pow((1.0 - sum(noise)) / noise.sd, 2);
}

TEST(Autoregression, FindsTheProcess) {
  for (const double coefficient : {0.0, 0.6, 0.9}) {
    const auto series = process(coefficient, 4000);
    const AutoregressiveNoise noise = estimate_noise(series, std::vector<bool>(series.size(), true));
    EXPECT_NEAR(noise.coefficients[0], coefficient, 0.05);
    EXPECT_NEAR(sum(noise), coefficient, 0.05);
    EXPECT_NEAR(information_about_level(noise) / std::pow((1.0 - coefficient) / 0.3, 2), 1.0, 0.25);
  }
}

TEST(Autoregression, ATransientHasLittleWeight) {
  auto series = process(0.5, 2000);
  for (std::size_t t = 1000; t < 1010; ++t) series[t] += Vec3(t % 2 == 0 ? 20.0 : -20.0, 0.0, 0.0);
  const AutoregressiveNoise noise = estimate_noise(series, std::vector<bool>(series.size(), true));
  EXPECT_LT(noise.weight[1005], 0.01);
  EXPECT_GT(noise.weight[500], 0.3);
  EXPECT_LT(noise.sd, 0.45);
}

TEST(Autoregression, WhatFollowsAGapHasNoWeight) {
  const auto series = process(0.5, 300);
  std::vector<bool> is_valid(series.size(), true);
  is_valid[100] = false;
  const AutoregressiveNoise noise = estimate_noise(series, is_valid);
  for (std::size_t t = 0; t < autoregressive_order; ++t) EXPECT_EQ(noise.weight[t], 0.0);
  for (std::size_t t = 100; t <= 100 + autoregressive_order; ++t) EXPECT_EQ(noise.weight[t], 0.0);
  EXPECT_GT(noise.weight[101 + autoregressive_order], 0.0);
}

TEST(Autoregression, ASeriesOfZerosIsNoCatastrophe) {
  const std::vector<Vec3> zeros(100, Vec3::Zero());
  const AutoregressiveNoise noise = estimate_noise(zeros, std::vector<bool>(100, true));
  EXPECT_TRUE(std::isfinite(noise.sd));
  EXPECT_GT(noise.sd, 0.0);
  EXPECT_TRUE(std::isfinite(noise.efficiency));
}

}  // namespace
}  // namespace kinfer
