// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/solver/model_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kinfer/base/rng.hpp"
#include "kinfer/estimate/continuous/solver/noise_update.hpp"

namespace kinfer {
namespace {

constexpr int intervals = 400;

/// Offsets of one instrument: white noise of one sigma, and a slow wave of this amplitude [sigma].
InstrumentFit offsets(double wave) {
  InstrumentFit fit;
  Rng rng(2);
  for (int k = 0; k < intervals; ++k) {
    std::array<float, 3> offset{};
    for (float& value : offset) value = static_cast<float>(rng.normal() + wave * std::sin(0.1 * k));
    fit.offset.push_back(offset);
  }
  return fit;
}

TEST(PersistentVariance, OfWhiteNoiseIsZeroAndOfASlowWaveItsOwn) {
  EXPECT_EQ(persistent_variance(offsets(0.0)), 0.0);
  EXPECT_NEAR(persistent_variance(offsets(3.0)), 3.0 * 4.5, 1.5);  // three axes, half the square of the amplitude
}

TEST(LongRunNoise, OfWhiteResidualsIsThatOfTheProblem) {
  InsProblem problem;
  problem.sensors.resize(1);
  problem.sensors[0].noise = {.angular_velocity = 0.01, .force = 0.1};
  InsCost cost{.total = 0.0, .sensors = std::vector<SensorFit>(1)};
  cost.sensors[0].angular_velocity = offsets(0.0);
  cost.sensors[0].force = offsets(3.0);
  const auto noise = long_run_noise(problem, cost);
  EXPECT_NEAR(noise[0].angular_velocity, 0.01, 0.0005);
  EXPECT_GT(noise[0].force, 0.5);  // variance 5.5, and alike for many intervals
}

TEST(RegressionDilution, IsThatOfTheAxesThatHardlyTurn) {
  constexpr double noise = 0.01, samples = 10.0;
  std::vector<InsBlock> blocks(intervals);
  Rng rng(3);
  for (int k = 0; k < intervals; ++k) {
    InsBlock& block = blocks[static_cast<std::size_t>(k)];
    block.rows = 1;
    block.samples = static_cast<int>(samples);
    block.factor(0, 0) = static_cast<float>(std::sqrt(samples));
    const Vec3 truth(std::sin(0.1 * k), 0.01 * std::sin(0.1 * k), 0.0);
    for (Eigen::Index axis = 0; axis < 3; ++axis)
      block.target(0, axis) = static_cast<float>(std::sqrt(samples) * truth[axis] + noise * rng.normal());
  }
  const Vec3 dilution = regression_dilution(blocks, noise);
  EXPECT_NEAR(dilution.x(), noise * noise / samples / 0.5, 2e-6);
  EXPECT_NEAR(dilution.y(), 0.2, 0.1);
  EXPECT_EQ(dilution.z(), 1.0);
}

}  // namespace
}  // namespace kinfer
