// SPDX-License-Identifier: Apache-2.0
#include "kinfer/measurement/sensor_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "kinfer/base/angle.hpp"

namespace kinfer {
namespace {

TEST(SensorModel, GradesHaveTheStatedFigures) {
  const SensorModel industrial = *sensor_grade("industrial");
  EXPECT_NEAR(industrial.accelerometer.noise_density / 9.80665, 120e-6, 1e-12);
  EXPECT_NEAR(industrial.gyroscope.instability / degree * 3600, 10.0, 1e-9);
  EXPECT_NEAR(industrial.gyroscope.resolution / degree, 1 / 65.5, 1e-12);
  EXPECT_EQ(sensor_grade("noise")->gyroscope.bias_sd, 0.0);
  EXPECT_NEAR(sensor_grade("consumer")->accelerometer.range / 9.80665, 8.0, 1e-12);
  EXPECT_FALSE(sensor_grade("military"));
}

TEST(SensorModel, NoiseOfARowIsDensityTimesRootOfHalfTheRate) {
  const InstrumentModel model{.noise_density = 0.02};
  for (const double rate : {50.0, 400.0}) {
    SimulatedInstrument instrument(model, {}, Rng(3));
    double squares = 0.0;
    constexpr int n = 50000;
    for (int i = 0; i < n; ++i) squares += instrument.read(Vec3::Zero(), 1 / rate).squaredNorm() / 3;
    EXPECT_NEAR(std::sqrt(squares / n) / (0.02 * std::sqrt(rate / 2)), 1.0, 4 / std::sqrt(6.0 * n));
  }
}

TEST(SensorModel, TheBiasProcessHasItsStandardDeviationAndCorrelationTime) {
  const InstrumentModel model{.instability = 2.0, .instability_time = 5.0};
  double variance = 0.0, covariance = 0.0;
  constexpr int runs = 4000;
  for (int run = 0; run < runs; ++run) {
    SimulatedInstrument instrument(model, {}, Rng(1).stream(run));
    const Vec3 now = instrument.read(Vec3::Zero(), 1.0);
    const Vec3 later = instrument.read(Vec3::Zero(), 5.0);
    variance += later.squaredNorm() / 3 / runs;
    covariance += now.dot(later) / 3 / runs;
  }
  EXPECT_NEAR(variance, 4.0, 0.2);
  EXPECT_NEAR(covariance, 4.0 * std::exp(-1.0), 0.2);
}

TEST(SensorModel, SamplesAreQuantisedWithinTheRange) {
  const InstrumentModel model{.range = 3.0, .resolution = 0.5};
  SimulatedInstrument instrument(model, {}, Rng(1));
  EXPECT_EQ(instrument.read(Vec3(0.74, -9.0, 0.2), 0.01), Vec3(0.5, -3.0, 0.0));
}

TEST(SensorModel, SamplesAreMatrixTimesTruthPlusBias) {
  const InstrumentModel model{.bias_sd = 1.0, .scale_sd = 0.01};
  const InstrumentErrors errors = sample_instrument_errors(model, Rng(8));
  SimulatedInstrument instrument(model, errors, Rng(1));
  const Vec3 truth(1, 2, 3);
  EXPECT_LT((instrument.read(truth, 0.01) - (errors.matrix * truth + errors.bias)).norm(), 1e-12);
  EXPECT_GT(errors.bias.norm(), 0.0);
}

}  // namespace
}  // namespace kinfer
