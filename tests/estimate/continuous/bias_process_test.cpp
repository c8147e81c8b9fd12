// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/model/bias_process.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kinfer/base/rng.hpp"
#include "kinfer/estimate/continuous/solver/batch_fit.hpp"
#include "kinfer/geometry/random.hpp"

namespace kinfer {
namespace {

using Eigen::Index;

constexpr double amplitude = 0.02, noise = 0.01;  // [m/s²]

double wave(double time) {
  return amplitude * std::sin(time / 10.0);
}

/// A stationary INS over two minutes; the bias of its accelerometer's x axis varies sinusoidally.
InsProblem standing() {
  InsProblem problem;
  problem.grid = {0.0, 0.1, 1200};
  problem.prior = {.gyroscope_bias = 1e-3, .accelerometer_bias = 1e-2};
  problem.bias_process = {.rate_sd = 1e-4, .force_sd = amplitude, .time = 20.0};
  Rng rng(2);
  InsSensor sensor{.name = "a", .acceleration = {}, .angular_velocity = {}, .field = {}, .faults = {}};
  std::vector<double> time;
  for (int row = 0; row < 6000; ++row) {
    time.push_back(0.02 * row);
    const Vec3 force = Vec3(wave(time.back()), 0.0, 9.80665) + noise * normal_vector(rng);
    for (std::size_t k = 0; k < 3; ++k) {
      sensor.angular_velocity.axis[k].push_back(static_cast<float>(1e-3 * rng.normal()));
      sensor.acceleration.axis[k].push_back(static_cast<float>(force[static_cast<Index>(k)]));
    }
  }
  sensor.faults.assign(time.size(), 0);
  problem.sensors.resize(1);
  problem.sensors[0].angular_velocity = ins_blocks(sensor, time, InsInstrument::gyroscope, problem.grid);
  problem.sensors[0].force = ins_blocks(sensor, time, InsInstrument::accelerometer, problem.grid);
  problem.sensors[0].noise = problem.sensors[0].noise_floor = {.angular_velocity = 1e-3, .force = noise};
  return problem;
}

InsUnknowns at_rest(const InsProblem& problem) {
  InsUnknowns start;
  start.bodies = {{.sensor = 0}};
  start.spline_coefficients.resize(0, problem.grid.coefficients());
  start.root_force = Vec3(0.0, 0.0, 9.8);
  start.errors.resize(1);
  return start;
}

TEST(BiasProcess, TimeSegmentsCoverTheGridWithoutGapsAndTheLastTakesTheRemainder) {
  for (const Index intervals : {5, 64, 127, 128, 1000, 36000}) {
    const SplineGrid grid{0.0, 0.1, intervals};
    const auto time_segments = time_segments_of(grid);
    Index at = 0;
    for (std::size_t k = 0; k < time_segments.size(); ++k) {
      EXPECT_EQ(time_segments[k].first, at);
      at = time_segments[k].end;
      EXPECT_EQ(time_segment_at(grid, time_segments[k].first), static_cast<Index>(k));
      EXPECT_EQ(time_segment_at(grid, time_segments[k].end - 1), static_cast<Index>(k));
    }
    EXPECT_EQ(at, intervals);
  }
}

TEST(BiasProcess, ATimeVaryingBiasIsFollowed) {
  InsProblem problem = standing();
  const InsFit fit = fit_ins(problem, at_rest(problem), {.threads = 1});
  const auto time_segments = time_segments_of(problem.grid);
  double difference = 0.0;
  for (std::size_t k = 0; k < time_segments.size(); ++k) {
    const double time = 0.05 * static_cast<double>(time_segments[k].first + time_segments[k].end);
    const double found = fit.unknowns.root_force.x() +
                         errors_at(problem, fit.unknowns, 0, time_segments[k].first).accelerometer_bias.x();
    difference = std::max(difference, std::abs(found - wave(time)));
  }
  EXPECT_LT(difference, 0.1 * amplitude);  // 0.6 mm/s² of noise a time segment, and the wave's curvature
}

TEST(BiasProcess, TheFitEndsAtTheOptimumOverTheBiases) {
  InsProblem problem = standing();
  const InsFit fit = fit_ins(problem, at_rest(problem), {.threads = 1});
  for (const Index time_segment : {0, 1, 9, 17})
    for (const Index unknown : {0, 3, 5})
      for (const double step : {-1e-4, 1e-4}) {
        InsUnknowns other = fit.unknowns;
        other.bias_process(unknown, time_segment) += step;
        EXPECT_GT(cost_of(problem, fit.layout, other, 1).total, fit.cost.total);
      }
}

TEST(BiasProcess, AConstantBiasHasNoProcess) {
  InsProblem problem = standing();
  problem.bias_process = {};
  const InsFit fit = fit_ins(problem, at_rest(problem), {.threads = 1});
  EXPECT_EQ(fit.unknowns.bias_process.size(), 0);
  EXPECT_EQ(errors_at(problem, fit.unknowns, 0, 700).accelerometer_bias, fit.unknowns.errors[0].accelerometer_bias);
}

}  // namespace
}  // namespace kinfer
