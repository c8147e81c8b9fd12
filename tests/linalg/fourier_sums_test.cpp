// SPDX-License-Identifier: Apache-2.0
#include "kinfer/linalg/fourier_sums.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kinfer/base/rng.hpp"

namespace kinfer {
namespace {

using Complex = std::complex<double>;

struct Samples {
  std::vector<double> angle;
  std::vector<Complex> weight;
};

Samples random_samples(int count, double range) {
  Rng rng(3);
  Samples samples;
  for (int i = 0; i < count; ++i) {
    samples.angle.push_back(range * (2.0 * rng.uniform() - 1.0));
    const double real = rng.normal(), imaginary = rng.normal();
    samples.weight.emplace_back(real, imaginary);
  }
  return samples;
}

/// Largest difference from sums one by one, over the sum of the weights' sizes.
double error_of(const Samples& samples, std::size_t orders) {
  const std::vector<Complex> sums = fourier_sums(samples.angle, samples.weight, orders);
  EXPECT_EQ(sums.size(), orders);
  double worst = 0.0, size = 0.0;
  for (const Complex& w : samples.weight) size += std::abs(w);
  for (std::size_t k = 0; k < sums.size(); ++k) {
    Complex sum = 0.0;
    for (std::size_t i = 0; i < samples.angle.size(); ++i)
      sum += samples.weight[i] * std::polar(1.0, static_cast<double>(k) * samples.angle[i]);
    worst = std::max(worst, std::abs(sums[k] - sum));
  }
  return worst / size;
}

TEST(FourierSums, AreThoseOfEachOrderByItself) {
  EXPECT_LT(error_of(random_samples(300, 4.0), 1), 1e-11);
  EXPECT_LT(error_of(random_samples(300, 4.0), 100), 1e-11);
  EXPECT_LT(error_of(random_samples(300, 40.0), 1029), 1e-11);  // several turns, negative ones too
}

TEST(FourierSums, OfASampleOnTheGridHaveItsWeight) {
  const std::vector<double> angle{std::numbers::pi, -std::numbers::pi, 0.0};
  const std::vector<Complex> weight{1.0, 1.0, 5.0};
  const std::vector<Complex> sums = fourier_sums(angle, weight, 4);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(std::abs(sums[k] - (k % 2 == 0 ? 7.0 : 3.0)), 0.0, 1e-11);
}

TEST(FourierSums, OfNothingAreZero) {
  EXPECT_TRUE(fourier_sums({}, {}, 0).empty());
  for (const Complex& sum : fourier_sums({}, {}, 5)) EXPECT_EQ(sum, Complex(0.0));
}

}  // namespace
}  // namespace kinfer
