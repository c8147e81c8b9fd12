// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/model/measurement_blocks.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kinfer/base/rng.hpp"

namespace kinfer {
namespace {

constexpr double period = 0.005;

double cubic(double t) {
  return 1.0 + 3.0 * t - 40.0 * t * t + 200.0 * t * t * t;
}

/// A sensor whose angular velocity about x is a cubic of time with white noise.
InsSensor sensor_of(std::span<const double> time, double noise) {
  InsSensor sensor{.name = "imu", .logger = 0, .acceleration = {}, .angular_velocity = {}, .field = {}, .faults = {}};
  Rng rng(3);
  for (const double t : time)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      sensor.angular_velocity.axis[axis].push_back(
          static_cast<float>((axis == 0 ? cubic(t) : 0.0) + noise * rng.normal()));
      sensor.acceleration.axis[axis].push_back(0.1f);
    }
  sensor.faults.assign(time.size(), 0);
  return sensor;
}

std::vector<double> times(std::size_t rows) {
  std::vector<double> time;
  for (std::size_t i = 0; i < rows; ++i) time.push_back(period * static_cast<double>(i));
  return time;
}

Eigen::Matrix<double, block_nodes, 1> truth_at_nodes(const SplineGrid& grid, Eigen::Index interval) {
  Eigen::Matrix<double, block_nodes, 1> x;
  for (std::size_t n = 0; n < block_nodes; ++n)
    x[static_cast<Eigen::Index>(n)] =
        cubic(grid.begin + grid.period * (static_cast<double>(interval) + block_nodes_u()[n]));
  return x;
}

TEST(MeasurementBlocks, ReproduceACubicExactlyWhicheverRowsAreMissing) {
  const std::vector<double> time = times(100);
  InsSensor sensor = sensor_of(time, 0.0);
  for (const std::size_t row : {3u, 4u, 5u, 25u, 38u}) sensor.faults[row] = angular_velocity_missing;
  for (std::size_t row = 41; row < 62; ++row) sensor.faults[row] = angular_velocity_missing;  // one sample is left
  const SplineGrid grid{0.0, 0.1, 5};
  const auto blocks = ins_blocks(sensor, time, InsInstrument::gyroscope, grid);
  ASSERT_EQ(blocks.size(), 5u);
  for (std::size_t k = 0; k < 5; ++k) {
    const auto predicted = truth_at_nodes(grid, static_cast<Eigen::Index>(k));
    EXPECT_LT((blocks[k].factor.cast<double>() * predicted - blocks[k].target.col(0).cast<double>()).norm(), 1e-4)
        << k;  // samples are float
    EXPECT_EQ(blocks[k].rows, std::min(blocks[k].samples, block_nodes));
  }
  EXPECT_EQ(blocks[0].samples, 17);
  EXPECT_EQ(blocks[2].rows, 1);
}

TEST(MeasurementBlocks, KeepAllInformationOfTheSamples) {
  const std::vector<double> time = times(20);
  const auto blocks = ins_blocks(sensor_of(time, 0.0), time, InsInstrument::gyroscope, {0.0, 0.1, 1});
  // A constant offset of n samples has information n.
  const Eigen::Matrix<double, block_nodes, 1> ones = Eigen::Matrix<double, block_nodes, 1>::Ones();
  EXPECT_NEAR((blocks[0].factor.cast<double>() * ones).squaredNorm(), 20.0, 1e-4);
}

TEST(MeasurementBlocks, HaveTheNoiseOfTheSamples) {
  const std::vector<double> time = times(8000);
  const auto blocks = ins_blocks(sensor_of(time, 0.01), time, InsInstrument::gyroscope, {0.0, 0.1, 20});
  EXPECT_NEAR(measurement_noise(blocks), 0.01, 0.0007);
}

TEST(MeasurementBlocks, FollowTheClockOffset) {
  const std::vector<double> time = times(40);
  const SplineGrid grid{0.0, 0.1, 2};
  const InsSensor sensor = sensor_of(time, 0.0);
  std::vector<double> late = time;
  for (double& t : late) t -= 0.03;
  const auto is = ins_blocks(sensor, late, InsInstrument::gyroscope, grid, 0.03);
  const auto ought = ins_blocks(sensor, time, InsInstrument::gyroscope, grid);
  EXPECT_LT((is[1].target - ought[1].target).norm(), 1e-5F);
}

}  // namespace
}  // namespace kinfer
