// SPDX-License-Identifier: Apache-2.0
#include "kinfer/inertial/allan.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kinfer/base/rng.hpp"
#include "kinfer/measurement/sensor_model.hpp"

namespace kinfer {
namespace {

TEST(Allan, WhiteNoiseFallsWithTheRootOfTheAveragingTime) {
  Rng rng(3);
  constexpr double sd = 0.2, period = 0.01;
  std::vector<double> values(200000);
  for (double& v : values) v = 5.0 + sd * rng.normal();
  for (const AllanPoint& p : allan_deviation(values, period)) {
    const double windows = 200000 * period / p.tau;
    EXPECT_NEAR(p.deviation / (sd * std::sqrt(period / p.tau)), 1.0, 3.0 / std::sqrt(windows)) << "tau " << p.tau;
  }
}

TEST(Allan, AgreesWithTheDefinitionOnARamp) {
  // Means of neighbouring windows of a ramp of slope r differ by r τ, so the deviation is r τ / √2.
  std::vector<double> ramp(1000);
  for (std::size_t i = 0; i < ramp.size(); ++i) ramp[i] = 0.5 * static_cast<double>(i);
  for (const AllanPoint& p : allan_deviation(ramp, 1.0))
    EXPECT_NEAR(p.deviation, 0.5 * p.tau / std::sqrt(2.0), 1e-9 * p.tau);
}

TEST(Allan, FindsTheNoiseAndTheBiasInstabilityOfASimulatedGyroscope) {
  InstrumentModel model{.noise_density = 1e-4, .instability = 1e-4, .instability_time = 500.0};
  SimulatedInstrument gyroscope(model, {}, Rng(2));
  std::vector<double> values;
  for (int i = 0; i < 400000; ++i) values.push_back(gyroscope.read(Vec3::Zero(), 0.01).x());
  const AllanCoefficients figures = allan_coefficients(allan_deviation(values, 0.01));
  EXPECT_NEAR(figures.noise_density / model.noise_density, 1.0, 0.1);
  // N²/(2τ) of the noise meets 2σ²τ/(3T) of a slow Gauss-Markov bias at τ = N/σ √(3T)/2 = 19 s.
  EXPECT_TRUE(figures.reaches_floor);
  EXPECT_NEAR(std::log(figures.instability_tau / 19.4), 0.0, std::log(2.0));
}

TEST(Allan, TooFewValuesGiveNoCurve) {
  EXPECT_TRUE(allan_deviation(std::vector<double>(5, 1.0), 0.01).empty());
  EXPECT_EQ(allan_coefficients({}).noise_density, 0.0);
}

}  // namespace
}  // namespace kinfer
