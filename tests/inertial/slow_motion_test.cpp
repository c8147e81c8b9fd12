// SPDX-License-Identifier: Apache-2.0
#include "kinfer/inertial/rest/slow_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "kinfer/base/rng.hpp"
#include "kinfer/geometry/random.hpp"
#include "kinfer/inertial/rest/steady_rotation.hpp"

namespace kinfer {
namespace slow_motion_test {
namespace {

constexpr double period = 0.01, gravity = 9.81;

/// A level sensor that turns about the vertical at this rate [rad/s], with a bias.
InsSensor turning(const std::string& name, const std::function<double(double)>& rate, const Vec3& bias,
                  std::vector<double>& time, Rng rng) {
  InsSensor sensor;
  sensor.name = name;
  time.clear();
  for (std::size_t row = 0; row < 4000; ++row) {
    time.push_back(period * static_cast<double>(row));
    const Vec3 rates = bias + Vec3(0.0, 0.0, rate(time.back())) + 8e-4 * normal_vector(rng);
    const Vec3 forces = Vec3(0.0, 0.0, gravity) + 8e-3 * normal_vector(rng);
    for (Eigen::Index k = 0; k < 3; ++k) {
      sensor.angular_velocity.axis[static_cast<std::size_t>(k)].push_back(static_cast<float>(rates[k]));
      sensor.acceleration.axis[static_cast<std::size_t>(k)].push_back(static_cast<float>(forces[k]));
    }
    sensor.faults.push_back(0);
  }
  return sensor;
}

double slewing_after_three_seconds(double t) {
  return t < 3.0 ? 0.0 : 0.02;
}

TEST(SlowMotion, ABaseThatWarmsUpRestsAndASlewOfTwoHundredthsMoves) {
  std::vector<double> time;
  const Vec3 bias(0.003, -0.002, 0.001);
  const InsSensor warming = turning(
                      "base", [](double t) { return 3e-3 * t / 40.0; }, bias, time, Rng(1)),
                  slewing = turning("carriage", slewing_after_three_seconds, bias, time, Rng(2)),
                  hinge = turning(
                      "hinge", [](double t) { return 0.03 * std::cos(1.2 * t); }, bias, time, Rng(3));
  EXPECT_LT(slow_motion_log_odds(slow_deviations(warming, time)), 0.0);
  EXPECT_GT(slow_motion_log_odds(slow_deviations(slewing, time)), 0.0);
  EXPECT_GT(slow_motion_log_odds(slow_deviations(hinge, time)), 0.0);
}

TEST(SlowMotion, ABiasThatDriftsInAllDirectionsIsNoMotionAndAsMuchAboutTheVerticalAloneIsASlew) {
  std::vector<double> time;
  InsSensor drifting = turning(
                "base", [](double t) { return 0.007 * (1.0 - std::exp(-t / 15.0)); }, Vec3::Zero(), time, Rng(4)),
            slewing = turning(
                "carriage", [](double t) { return std::fmod(t, 16.0) < 8.0 ? 0.012 : -0.012; }, Vec3::Zero(), time,
                Rng(5));
  for (std::size_t row = 0; row < time.size(); ++row)
    for (const std::size_t axis : {0U, 1U})
      drifting.angular_velocity.axis[axis][row] += static_cast<float>(0.009 * (1.0 - std::exp(-time[row] / 15.0)));
  EXPECT_LT(slow_motion_log_odds(slow_deviations(drifting, time)), 0.0);
  EXPECT_GT(slow_motion_log_odds(slow_deviations(slewing, time)), 0.0);
}

InsRecording recording_of(const std::vector<std::pair<std::function<double(double)>, Vec3>>& sensors) {
  InsRecording recording;
  recording.loggers.emplace_back();
  for (std::size_t s = 0; s < sensors.size(); ++s)
    recording.sensors.push_back(
        turning("ins" + std::to_string(s), sensors[s].first, sensors[s].second, recording.loggers[0].time, Rng(s + 1)));
  return recording;
}

bool rotates(const std::vector<RestPeriod>& rests) {
  return steady_rate_limit(rests).has_value();
}

double still(double) {
  return 0.0;
}

double slewing(double) {
  return 0.03;
}

TEST(SteadyRotation, WhatTheSensorsOfACarriageHaveInCommonIsNoBias) {
  const auto rests = rest_periods_of(recording_of(
      {{still, {0.003, 0.002, -0.002}}, {slewing, {-0.002, 0.001, 0.003}}, {slewing, {0.001, -0.003, -0.001}}}));
  EXPECT_FALSE(rotates(rests[0]));
  for (const std::size_t s : {1U, 2U}) {
    ASSERT_TRUE(rotates(rests[s])) << s;
    EXPECT_NEAR(rests[s].front().rotation.z(), 0.03, 4e-3);
  }
}

TEST(SteadyRotation, ABiasDoesNotJump) {
  const auto rests = rest_periods_of(
      recording_of({{still, {0.003, 0.002, -0.002}}, {slewing_after_three_seconds, {-0.002, 0.001, 0.003}}}));
  EXPECT_FALSE(rotates(rests[0]));
  ASSERT_GT(rests[1].size(), 2U);
  EXPECT_FALSE(rotates({rests[1].front()}));
  EXPECT_TRUE(rotates({rests[1].back()}));
}

TEST(SteadyRotation, LargeBiasesOfCheapSensorsAreBiases) {
  const auto rests = rest_periods_of(
      recording_of({{still, {0.03, -0.02, 0.025}}, {still, {-0.015, 0.03, -0.03}}, {still, {0.02, 0.01, 0.04}}}));
  for (const auto& of_sensor : rests) EXPECT_FALSE(rotates(of_sensor));
}

}  // namespace
}  // namespace slow_motion_test
}  // namespace kinfer
