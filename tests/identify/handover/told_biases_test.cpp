// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/handover/told_biases.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace kinfer {
using namespace identify;
namespace {

using Kind = TrackingParameterKind;

const Vec3 bias(0.01, -0.02, 0.03);  // [rad/s]

/// Two sensors that turn about the vertical, but for one of them which waits for five seconds first.
InsRecording recording() {
  InsRecording result{.loggers = {{.name = "log"}}, .sensors = {{.name = "moving"}, {.name = "resting"}}};
  for (int row = 0; row < 2000; ++row) {
    const double t = 0.01 * row;
    result.loggers.front().time.push_back(t);
    for (InsSensor& sensor : result.sensors) {
      const double rate = sensor.name == "resting" && t < 5.0 ? 0.0 : 0.5 * std::sin(0.9 * t + 1.0);
      for (std::size_t k = 0; k < 3; ++k) {
        sensor.angular_velocity.axis[k].push_back(k == 2 ? static_cast<float>(rate) : 0.0F);
        sensor.acceleration.axis[k].push_back(k == 2 ? 9.81F : 0.0F);
      }
      sensor.faults.push_back(field_missing);
    }
  }
  return result;
}

/// The sensors in the other order, and one that is not in the recording; each bias known to `sd` at worst.
TrackingModel model(double sd) {
  TrackingModel result;
  for (const char* name : {"elsewhere", "resting", "moving"}) {
    const int index = static_cast<int>(result.sensors.size());
    result.sensors.push_back({.name = name, .body = index, .gyroscope_bias = bias});
    for (int k = 0; k < 3; ++k) result.parameters.push_back({Kind::gyroscope_bias, index, k});
  }
  result.parameters.push_back({Kind::accelerometer_bias, 2, 0});
  VectorXd variance = VectorXd::Constant(10, 0.01 * sd * sd);
  variance[7] = sd * sd;  // "moving", y
  variance[9] = 1.0;
  result.covariance = variance.asDiagonal();
  return result;
}

TEST(ToldBiases, AreThoseOfSensorsThatNeverRest) {
  const auto told = told_biases(model(0.004), recording(), {});
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told.front().sensor, "moving");
  EXPECT_EQ(told.front().mean, bias);
  EXPECT_DOUBLE_EQ(told.front().sd, 0.004) << "of the worst axis";
}

TEST(ToldBiases, AreNoBetterThanABiasStays) {
  const auto told = told_biases(model(1e-6), recording(), {});
  ASSERT_EQ(told.size(), 1U);
  EXPECT_GT(told.front().sd, 1e-4);
  EXPECT_LT(told.front().sd, 3e-3);
}

TEST(ToldBiases, AreInTheUnitsOfTheMendedRecording) {
  InsCommonScales common;
  common.gyroscope.factor = 2.0;
  const auto told = told_biases(model(0.004), recording(), common);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_LT((told.front().mean - 0.5 * bias).norm(), 1e-15);
  EXPECT_DOUBLE_EQ(told.front().sd, 0.002);
}

TEST(ToldBiases, AgreeWithinTheirStandardDeviations) {
  const std::vector<GyroscopeBias> before{{"a", bias, 1e-3}, {"b", bias, 1e-3}};
  EXPECT_TRUE(agrees_with_one_of(before, {"b", bias + Vec3(0.0, 1e-3, 0.0), 1e-3}));
  EXPECT_FALSE(agrees_with_one_of(before, {"b", bias + Vec3(0.0, 5e-3, 0.0), 1e-3}));
  EXPECT_FALSE(agrees_with_one_of(before, {"c", bias, 1e-3})) << "it was not told";
  EXPECT_FALSE(agrees_with_one_of({}, {"a", bias, 1e-3}));
}

}  // namespace
}  // namespace kinfer
