// SPDX-License-Identifier: Apache-2.0
// Residuals of single instruments in single intervals: robust weights, clocks, mounts, noise from residuals.
#include "kinfer/estimate/continuous/solver/block_residual.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "kinfer/base/rng.hpp"
#include "kinfer/estimate/continuous/model/mount_compliance.hpp"
#include "kinfer/estimate/continuous/solver/noise_update.hpp"
#include "support/differences.hpp"
#include "support/random.hpp"

namespace kinfer {
namespace {

using Eigen::Index;
using test::random_vector;
using testing::numeric_jacobian;

TEST(RobustCost, IsTheSquareUpToItsLimitAndItsWeightIsItsSlope) {
  for (const double terms : {3.0, 12.0, 60.0}) {
    const double limit = terms + 4.0 * std::sqrt(2.0 * terms);
    EXPECT_EQ(robust(0.5 * limit, terms).cost, 0.5 * limit);
    EXPECT_EQ(robust(0.5 * limit, terms).weight, 1.0);
    EXPECT_NEAR(robust(limit * (1 + 1e-12), terms).cost, limit, 1e-9) << "no step at the limit";
    for (const double squares : {0.3 * limit, 1.5 * limit, 40.0 * limit}) {
      const double h = 1e-5 * squares;
      EXPECT_NEAR((robust(squares + h, terms).cost - robust(squares - h, terms).cost) / (2 * h),
                  robust(squares, terms).weight, 1e-8);
    }
    EXPECT_EQ(robust(std::numeric_limits<double>::infinity(), terms).weight, 0.0);
  }
}

TEST(ClockShift, IsOffsetPlusDriftFromTheMiddleInIntervals) {
  InsProblem problem;
  problem.grid = {.begin = 5.0, .period = 0.2, .intervals = 11};
  double sum = 0.0;
  for (Index k = 0; k < 11; ++k) sum += from_middle(problem.grid, k);
  EXPECT_NEAR(sum, 0.0, 1e-14);
  EXPECT_NEAR(from_middle(problem.grid, 5), 0.0, 1e-15);
  EXPECT_NEAR(from_middle(problem.grid, 10), 1.0, 1e-15);
  InsLayout layout;
  const InsErrors errors{.clock = {.offset = 0.01, .drift = 0.003}};
  EXPECT_EQ(clock_shift(problem, layout, errors, 10), 0.0) << "clocks are not estimated";
  layout.has_clocks = true;
  EXPECT_NEAR(clock_shift(problem, layout, errors, 10), 0.013 / 0.2, 1e-15);
  EXPECT_NEAR(clock_shift(problem, layout, errors, 0), 0.007 / 0.2, 1e-15);
}

TEST(ClockShift, ShiftedFactorReadsAStraightLineLater) {
  InsBlock block;
  block.rows = 4;
  block.factor.setIdentity();
  InsLayout layout;
  Eigen::Matrix<double, block_nodes, 1> line, later;
  for (std::size_t n = 0; n < block_nodes; ++n) {
    line[static_cast<Index>(n)] = 2.0 + 3.0 * block_nodes_u()[n];
    later[static_cast<Index>(n)] = 2.0 + 3.0 * (block_nodes_u()[n] + 0.1);
  }
  EXPECT_LT((shifted_factor(block, layout, 0.1) * line - line).norm(), 1e-15);
  layout.has_clocks = true;
  EXPECT_LT((shifted_factor(block, layout, 0.1) * line - later).norm(), 1e-12);
}

TEST(BlockResidualOf, IsWhitenedAndZeroForWhatWasPredicted) {
  Rng rng(3);
  InsBlock block;
  block.rows = 4;
  BlockResidual predicted;
  for (Index i = 0; i < block_nodes; ++i) {
    for (Index j = i; j < block_nodes; ++j) block.factor(i, j) = static_cast<float>(rng.normal());
    predicted.row(i) = random_vector(rng).transpose();
  }
  const NodeMatrix factor = block.factor.cast<double>();
  block.target = (factor * predicted).cast<float>();
  EXPECT_LT(residual(block, factor, predicted, 0.5).norm(), 1e-5);
  block.target.array() += 1.0f;
  EXPECT_LT((residual(block, factor, predicted, 0.5).array() - 2.0).matrix().norm(), 1e-5);
}

TEST(Instruments, ReadTheStateThroughTheirErrors) {
  Rng rng(4);
  InsProblem problem;
  problem.sensors.resize(1);
  problem.sensors[0].noise = {0.1, 0.2};
  const auto list = instruments(problem, 0);
  ASSERT_EQ(list.size(), 2u);
  const InsState state{random_vector(rng), random_vector(rng), random_vector(rng)};
  InsErrors errors{.gyroscope_bias = Vec3(1, 2, 3), .accelerometer_bias = Vec3(4, 5, 6)};
  errors.gyroscope_scale = 0.1 * Mat3::Identity(), errors.accelerometer_scale = -0.2 * Mat3::Identity();
  EXPECT_LT((list[0].read(state, errors) - 1.1 * state.angular_velocity - Vec3(1, 2, 3)).norm(), 1e-14);
  EXPECT_LT((list[1].read(state, errors) - 0.8 * state.force - Vec3(4, 5, 6)).norm(), 1e-14);
  EXPECT_EQ(list[1].sd, 0.2);
}

TEST(MountDerivativeOf, AgreesWithDifferencesAndWithTheStateItself) {
  Rng rng(5);
  for (const double lean : {0.0, 0.02, 0.3}) {
    const InsState segment{random_vector(rng), random_vector(rng), random_vector(rng)};
    Mat3 tilt;
    for (int j = 0; j < 3; ++j) tilt.col(j) = lean * random_vector(rng);
    const Vec3 force = random_vector(rng), change = random_vector(rng);
    const MountDerivative d = state_on_mount_derivative(segment, tilt, force, change);
    const InsState state = state_on_mount(segment, tilt, force, change);
    EXPECT_LT((d.state.angular_velocity - state.angular_velocity).norm(), 1e-12);
    EXPECT_LT((d.state.force - state.force).norm(), 1e-12);
    EXPECT_LT((d.turn * segment.force - state.force).norm(), 1e-13);
    const auto by_tilt = [&](Vec3 InsState::*member) {
      return numeric_jacobian(
          [&](const VectorXd& at) {
            return VectorXd(state_on_mount(segment, Mat3(at.reshaped(3, 3)), force, change).*member);
          },
          VectorXd(tilt.reshaped()));
    };
    EXPECT_LT((d.velocity_by_tilt - by_tilt(&InsState::angular_velocity)).norm(), 1e-7);
    EXPECT_LT((d.force_by_tilt - by_tilt(&InsState::force)).norm(), 1e-7);
  }
}

TEST(SensorState, OnAFirmMountIsThatOfItsSegment) {
  Rng rng(6);
  InsProblem problem;
  problem.sensors.resize(1);
  problem.sensors[0].mount_load.resize(2);
  problem.sensors[0].mount_load[1].force.setConstant(2.0f);
  InsUnknowns x;
  x.errors.resize(1);
  x.errors[0].tilt = 0.05 * rot_x(0.3);
  const InsState segment{random_vector(rng), random_vector(rng), random_vector(rng)};
  InsLayout layout;
  EXPECT_EQ(sensor_state_at(problem, layout, x, 0, 1, 3, segment).force, segment.force);
  layout.has_tilts = true;
  const InsState on_mount = sensor_state_at(problem, layout, x, 0, 1, 3, segment);
  EXPECT_LT((on_mount.force - exp_so3(-x.errors[0].tilt * Vec3::Constant(2.0)) * segment.force).norm(), 1e-14);
  EXPECT_EQ(sensor_state_at(problem, layout, x, 0, 0, 3, segment).force, segment.force) << "no load in this interval";
}

/// One instrument's fit with offsets of unit variance from a first-order process.
InstrumentFit correlated_fit(double decay, std::size_t intervals) {
  InstrumentFit fit;
  Rng rng(7);
  std::array<double, 3> now{rng.normal(), rng.normal(), rng.normal()};
  for (std::size_t k = 0; k < intervals; ++k) {
    for (double& value : now) value = decay * value + std::sqrt(1 - decay * decay) * rng.normal();
    fit.offset.push_back({static_cast<float>(now[0]), static_cast<float>(now[1]), static_cast<float>(now[2])});
  }
  return fit;
}

/// Variance of a long mean of the offsets, in that of a mean of white noise.
double long_run_ratio(const InstrumentFit& fit) {
  InsProblem problem;
  problem.sensors.resize(1);
  problem.sensors[0].noise = {.angular_velocity = 2.0, .force = 3.0};
  InsCost cost{.total = 0.0, .sensors = std::vector<SensorFit>(1)};
  cost.sensors[0].force = fit;
  const InsNoise noise = long_run_noise(problem, cost)[0];
  EXPECT_EQ(noise.angular_velocity, 2.0) << "no offsets, no change";
  return std::pow(noise.force / 3.0, 2);
}

TEST(LongRunNoise, OfAFirstOrderProcessIsOnePlusDecayOverOneMinusDecay) {
  for (const double decay : {0.0, 0.5, 0.8}) {
    const double expected = (1 + decay) / (1 - decay);
    EXPECT_NEAR(long_run_ratio(correlated_fit(decay, 20000)), expected, 0.15 * expected) << decay;
  }
}

TEST(LongRunNoise, IgnoresMissingIntervalsAndNeverFallsBelowTheProblems) {
  InstrumentFit fit = correlated_fit(0.5, 20000), none;
  for (std::size_t k = 0; k < fit.offset.size(); k += 7) fit.offset[k].fill(no_measurement);
  EXPECT_NEAR(long_run_ratio(fit), 3.0, 0.5);
  EXPECT_EQ(long_run_ratio(none), 1.0);
  none.offset.assign(100, {0.0f, 0.0f, 0.0f});
  EXPECT_EQ(long_run_ratio(none), 1.0);
}

/// Three sensors whose gyroscope residuals are so many times larger than their noise.
InsCost residual_levels(std::array<double, 3> levels) {
  InsCost cost;
  for (const double level : levels) {
    SensorFit fit;
    fit.angular_velocity.block.assign(200, static_cast<float>(level * level));
    fit.force.block.assign(200, 1.0f);
    cost.sensors.push_back(fit);
  }
  return cost;
}

InsProblem three_sensors() {
  InsProblem problem;
  problem.sensors.resize(3);
  for (InsMeasurements& sensor : problem.sensors) sensor.noise = sensor.noise_floor = {0.01, 0.1};
  return problem;
}

TEST(NoiseUpdate, SetsTheNoiseToThatOfTheResiduals) {
  InsProblem problem = three_sensors();
  const InsCost cost = residual_levels({3.0, 3.0, 3.0});
  EXPECT_TRUE(needs_reweighting(problem, cost));
  EXPECT_TRUE(update_noise(problem, cost));
  for (const InsMeasurements& sensor : problem.sensors) {
    EXPECT_NEAR(sensor.noise.angular_velocity, 0.03, 1e-7);
    EXPECT_NEAR(sensor.noise.force, 0.1, 1e-7);
  }
  EXPECT_FALSE(needs_reweighting(problem, residual_levels({1.0, 1.0, 1.0}))) << "now it is what is seen";
}

TEST(NoiseUpdate, NeverFallsBelowTheInstrumentNorFarFromTheOtherSensors) {
  InsProblem problem = three_sensors();
  EXPECT_FALSE(update_noise(problem, residual_levels({0.2, 0.3, 0.2})));
  EXPECT_EQ(problem.sensors[0].noise.angular_velocity, 0.01);
  update_noise(problem, residual_levels({1.0, 4.0, 40.0}));
  EXPECT_NEAR(problem.sensors[0].noise.angular_velocity, 0.01 * 4.0 / 1.5, 1e-7);
  EXPECT_NEAR(problem.sensors[1].noise.angular_velocity, 0.04, 1e-7);
  EXPECT_NEAR(problem.sensors[2].noise.angular_velocity, 0.01 * 4.0 * 1.5, 1e-7);
}

TEST(NoiseUpdate, SensorsOutsideOfTheChainSayNothingOfTheOthers) {
  InsProblem problem = three_sensors();
  InsCost cost = residual_levels({4.0, 1.0, 1.0});
  for (const std::size_t outside : {1U, 2U}) cost.sensors[outside] = {};
  EXPECT_TRUE(update_noise(problem, cost));
  EXPECT_NEAR(problem.sensors[0].noise.angular_velocity, 0.04, 1e-7);
  EXPECT_EQ(problem.sensors[1].noise.angular_velocity, 0.01);
}

TEST(NoiseUpdate, AFewShocksDoNotCount) {
  InsProblem problem = three_sensors();
  InsCost cost = residual_levels({1.0, 1.0, 1.0});
  for (std::size_t k = 0; k < 10; ++k) cost.sensors[0].angular_velocity.block[19 * k] = 1e6f;
  EXPECT_FALSE(update_noise(problem, cost));
}

}  // namespace
}  // namespace kinfer
