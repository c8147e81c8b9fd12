// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/fast_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "kinfer/base/rng.hpp"
#include "kinfer/estimate/continuous/model/measurement_blocks.hpp"

namespace kinfer {
namespace {

constexpr InsNoise quiet{.angular_velocity = 1e-3, .force = 0.01};  // [rad/s], [m/s²]
constexpr double jerky = 14.1;                                      // [s] middle of the jerk
constexpr SplineGrid wide_knots{.begin = 0.0, .period = 0.07, .intervals = 400};

struct Signals {
  InsSensor sensor;
  std::vector<double> time;
};

/// A slow motion; from 14 s on `jerk` [m/s³] for 0.1 s, and back; a wave of 20 Hz of the size `wave` [m/s²] all along.
Signals jerky_signals(double jerk, double wave = 0.0) {
  Signals s;
  Rng rng(3);
  for (int i = 0; i < 2800; ++i) {
    const double t = 0.01 * i;
    s.time.push_back(t);
    const double burst = jerk * std::max(0.0, 0.1 - std::abs(t - jerky));
    for (std::size_t k = 0; k < 3; ++k) {
      s.sensor.angular_velocity.axis[k].push_back(
          static_cast<float>(0.4 * std::sin(1.3 * t + static_cast<double>(k)) + quiet.angular_velocity * rng.normal()));
      s.sensor.acceleration.axis[k].push_back(static_cast<float>(3.0 * std::sin(2.1 * t + static_cast<double>(k)) +
                                                                 burst + wave * std::sin(125.7 * t) +
                                                                 quiet.force * rng.normal()));
    }
    s.sensor.faults.push_back(field_missing);
  }
  return s;
}

std::ptrdiff_t raised(const std::vector<double>& variances) {
  return std::ranges::count_if(variances, [](double v) { return v > 1.0; });
}

TEST(FastMotion, WhatSplinesFollowKeepsItsWeight) {
  const Signals s = jerky_signals(0.0);
  const auto found = unfollowed_variances(s.sensor, s.time, wide_knots, quiet);
  for (const std::vector<double>& instrument : found) {
    ASSERT_EQ(instrument.size(), 400U);
    EXPECT_EQ(raised(instrument), 0);
  }
}

TEST(FastMotion, AJerkIsDiscountedWhereItIs) {
  const Signals s = jerky_signals(3.0);
  const auto found = unfollowed_variances(s.sensor, s.time, wide_knots, quiet);
  EXPECT_EQ(raised(found[0]), 0) << "the gyroscope does not see it";
  EXPECT_GT(raised(found[1]), 4);
  EXPECT_LT(raised(found[1]), 14);
  const auto at = static_cast<std::size_t>(jerky / wide_knots.period);
  EXPECT_GT(found[1][at], 5.0);
  for (std::size_t k = 0; k < found[1].size(); ++k)
    if (k + 7 < at || k > at + 7) EXPECT_LT(found[1][k], 2.5) << k;
}

TEST(FastMotion, AnInstrumentThatSplinesDoNotFollowAtAllIsLeftAsItIs) {
  const Signals s = jerky_signals(3.0, 1.0);
  const auto found = unfollowed_variances(s.sensor, s.time, wide_knots, quiet);
  EXPECT_EQ(raised(found[1]), 0);
}

TEST(FastMotion, DiscountedMeasurementsAreTheSameWithLessInformation) {
  const Signals s = jerky_signals(3.0);
  InsMeasurements measured{.angular_velocity = ins_blocks(s.sensor, s.time, InsInstrument::gyroscope, wide_knots),
                           .force = ins_blocks(s.sensor, s.time, InsInstrument::accelerometer, wide_knots),
                           .noise = quiet,
                           .noise_floor = quiet};
  const std::vector<InsBlock> before = measured.force;
  discount_fast_motion(measured, s.sensor, s.time, wide_knots);
  const auto at = static_cast<std::size_t>(jerky / wide_knots.period);
  const InsBlock &was = before[at], &is = measured.force[at];
  const auto excess = double{is.excess};
  EXPECT_GT(excess, 5.0);
  EXPECT_NEAR(double{is.factor(0, 0)} * std::sqrt(excess), double{was.factor(0, 0)}, 1e-5);
  const auto values = [](const InsBlock& block) {  // at the nodes
    return (block.factor.cast<double>().triangularView<Eigen::Upper>().solve(block.target.cast<double>())).eval();
  };
  EXPECT_LT((values(is) - values(was)).norm(), 1e-3);
  EXPECT_NEAR(double{is.left.sum()} * excess, double{was.left.sum()}, 1e-3 * double{was.left.sum()});
  EXPECT_EQ(measured.force[10].excess, 1.0F);
}

TEST(FastMotion, CountsAgainAtItsFullWeight) {
  const Signals s = jerky_signals(3.0);
  InsProblem problem;
  problem.sensors.push_back({.angular_velocity = ins_blocks(s.sensor, s.time, InsInstrument::gyroscope, wide_knots),
                             .force = ins_blocks(s.sensor, s.time, InsInstrument::accelerometer, wide_knots),
                             .noise = quiet,
                             .noise_floor = quiet});
  EXPECT_FALSE(discounts_fast_motion(problem));
  const std::vector<InsBlock> before = problem.sensors[0].force;
  discount_fast_motion(problem.sensors[0], s.sensor, s.time, wide_knots);
  EXPECT_TRUE(discounts_fast_motion(problem));
  count_fast_motion(problem);
  EXPECT_FALSE(discounts_fast_motion(problem));
  for (std::size_t k = 0; k < before.size(); ++k)
    ASSERT_LT((problem.sensors[0].force[k].target - before[k].target).norm(), 1e-4F * (1.0F + before[k].target.norm()));
}

TEST(FastMotion, WithoutMeasurementsNothingIsDiscounted) {
  Signals s = jerky_signals(0.0);
  std::ranges::fill(s.sensor.faults, static_cast<std::uint8_t>(field_missing | acceleration_missing));
  const auto found = unfollowed_variances(s.sensor, s.time, wide_knots, quiet);
  EXPECT_EQ(raised(found[0]) + raised(found[1]), 0);
}

}  // namespace
}  // namespace kinfer
