// SPDX-License-Identifier: Apache-2.0
#include "kinfer/inertial/clipped_peaks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinfer/base/rng.hpp"
#include "kinfer/measurement/ins/ins_screening.hpp"

namespace kinfer {
namespace {

/// A sensor that swings about its x axis at 0.4 Hz with 0.8 rad/s and heaves along z; both clip.
struct SwingingSensor {
  InsSensor sensor{.name = "s", .acceleration = {}, .angular_velocity = {}, .field = {}, .faults = {}};
  std::vector<double> time, rate, force;
  float rate_range, force_range;

  explicit SwingingSensor(float range_of_rate = 0.4f, float range_of_force = 12.0f)
      : rate_range(range_of_rate), force_range(range_of_force) {
    Rng rng(3);
    for (int row = 0; row < 4000; ++row) {
      time.push_back(0.005 * row);
      const double phase = 2.0 * std::numbers::pi * 0.4 * time.back();
      rate.push_back(0.8 * std::sin(phase));
      force.push_back(9.8 + 4.0 * std::sin(1.7 * phase));
      const std::array<double, 3> rates{rate.back(), 0.1 * std::cos(phase), 0.0},
          forces{0.5 * std::cos(phase), 0.0, force.back()};
      for (std::size_t k = 0; k < 3; ++k) {
        const auto noisy = [&](double value, double noise) { return static_cast<float>(value + noise * rng.normal()); };
        sensor.angular_velocity.axis[k].push_back(std::clamp(noisy(rates[k], 1e-3), -rate_range, rate_range));
        sensor.acceleration.axis[k].push_back(std::clamp(noisy(forces[k], 0.02), -force_range, force_range));
      }
    }
    flag_faults(sensor);
  }
};

TEST(ClippedPeaks, AreRestoredToAFewPercent) {
  const SwingingSensor swinging;
  ASSERT_GT(count(swinging.sensor, angular_velocity_clipped), 1000u);
  ASSERT_GT(count(swinging.sensor, acceleration_clipped), 500u);
  const InsSensor restored = restore_clipped_peaks(swinging.sensor, swinging.time);
  double rate = 0.0, force = 0.0, angle = 0.0, largest_angle = 0.0;
  for (std::size_t row = 300; row < 3700; ++row) {
    const double error = double{restored.angular_velocity.axis[0][row]} - swinging.rate[row];
    rate = std::max(rate, std::abs(error));
    force = std::max(force, std::abs(double{restored.acceleration.axis[2][row]} - swinging.force[row]));
    angle += 0.005 * error;
    largest_angle = std::max(largest_angle, std::abs(angle));
  }
  EXPECT_LT(rate, 0.05);
  EXPECT_LT(force, 0.3);
  EXPECT_LT(largest_angle, 0.01) << "with the clipped values it would be 0.2";
  EXPECT_EQ(count(restored, angular_velocity_clipped), 0u);
  EXPECT_EQ(count(restored, acceleration_clipped), 0u);
}

TEST(ClippedPeaks, AreNeverInsideTheRange) {
  const SwingingSensor swinging;
  const InsSensor restored = restore_clipped_peaks(swinging.sensor, swinging.time);
  for (std::size_t row = 0; row < swinging.time.size(); ++row)
    if (std::abs(swinging.sensor.angular_velocity.axis[0][row]) >= swinging.rate_range) {
      EXPECT_GE(std::abs(restored.angular_velocity.axis[0][row]), swinging.rate_range);
    }
}

TEST(ClippedPeaks, WhatIsMeasuredStaysAsItIs) {
  const SwingingSensor swinging;
  const InsSensor restored = restore_clipped_peaks(swinging.sensor, swinging.time);
  EXPECT_EQ(restored.angular_velocity.axis[1], swinging.sensor.angular_velocity.axis[1]);
  const SwingingSensor sound(2.0f, 100.0f);
  EXPECT_EQ(restore_clipped_peaks(sound.sensor, sound.time).angular_velocity.axis, sound.sensor.angular_velocity.axis);
}

TEST(ClippedPeaks, AtTheEndsKeepTheirValues) {
  SwingingSensor swinging;
  const auto end = static_cast<std::ptrdiff_t>(125);  // at the first peak
  for (auto* triad : {&swinging.sensor.acceleration, &swinging.sensor.angular_velocity})
    for (auto& axis : triad->axis) axis.resize(static_cast<std::size_t>(end));
  swinging.sensor.faults.resize(static_cast<std::size_t>(end));
  const InsSensor restored =
      restore_clipped_peaks(swinging.sensor, std::span(swinging.time).first(static_cast<std::size_t>(end)));
  EXPECT_EQ(restored.angular_velocity.axis[0].back(), swinging.rate_range);
}

}  // namespace
}  // namespace kinfer
