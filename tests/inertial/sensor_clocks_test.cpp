// SPDX-License-Identifier: Apache-2.0
#include "kinfer/inertial/sensor_clocks.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/carried_sensor.hpp"

namespace kinfer {
namespace {

using testing::carried;
using testing::CarriedSensor;

/// Two sensors of one body in general position; the second logs with a delay `late` and drifts.
InsRecording two_clocks(double late, double drift, double seconds) {
  const SensorModel grade = *sensor_grade("industrial");
  CarriedSensor a = carried({.seconds = seconds, .sampling_rate = 100.0, .grade = &grade, .has_magnetometer = false});
  CarriedSensor b = carried({.seconds = seconds,
                             .sampling_rate = 100.0,
                             .mounting = Quat(from_rpy({1, 2, 3})),
                             .grade = &grade,
                             .has_magnetometer = false,
                             .seed = 5});
  for (double& t : b.time) t += late + drift * (t - 0.5 * seconds);
  InsRecording recording;
  recording.loggers = {{"a", a.time}, {"b", b.time}};
  recording.sensors = {a.sensor, b.sensor};
  recording.sensors[1].logger = 1;
  return recording;
}

TEST(SensorClocks, AreFoundToAMillisecondForAnyStart) {
  for (const double late : {0.0, 0.013, -0.05, 8.0, -1000.003}) {
    const auto clocks = estimate_sensor_clocks(two_clocks(late, 0.0, 60.0));
    EXPECT_TRUE(clocks[0].known && clocks[1].known);
    EXPECT_NEAR(clocks[1].correction.shift_at(30.0 + late) - clocks[0].correction.offset, -late, 1e-3) << late;
  }
}

TEST(SensorClocks, ADriftShowsInALongRecording) {
  const auto clocks = estimate_sensor_clocks(two_clocks(0.02, 8e-5, 600.0));
  EXPECT_NEAR(clocks[1].correction.drift, -8e-5, 5e-6);
}

TEST(SensorClocks, ALargeDriftShowsInAShortRecordingToo) {
  for (const double drift : {5e-4, 1e-3, -2e-3, 5e-3}) {
    const auto clocks = estimate_sensor_clocks(two_clocks(0.02, drift, 60.0));
    EXPECT_NEAR(clocks[1].correction.drift, -drift, 1e-4) << drift;
    EXPECT_NEAR(clocks[1].correction.shift_at(30.0), -0.02, 2e-3) << drift;
  }
  EXPECT_LT(std::abs(estimate_sensor_clocks(two_clocks(0.02, 0.0, 60.0))[1].correction.drift), 1e-12);
}

TEST(SensorClocks, ADriftOfTheLargestKindShowsInALongRecording) {
  const auto clocks = estimate_sensor_clocks(two_clocks(0.02, 1e-3, 600.0));
  EXPECT_NEAR(clocks[1].correction.drift, -1e-3, 5e-5);
}

std::vector<ClockCorrection> drifts(std::initializer_list<double> all) {
  std::vector<ClockCorrection> corrections;
  for (const double drift : all) corrections.push_back({.offset = 0.0, .drift = drift, .middle = 10.0});
  return corrections;
}

TEST(CommonDrift, TheOddClockIsTheOneThatTheOthersDisagreeWith) {
  EXPECT_NEAR(common_drift(drifts({0.0, -1e-3, -1.01e-3, -0.99e-3})), -1e-3, 2e-5) << "the reference is the odd one";
  EXPECT_EQ(common_drift(drifts({0.0, 1e-5, 1e-3})), 0.0);
  EXPECT_EQ(common_drift(drifts({0.0, 1e-3})), 0.0) << "one against one: the first";
  EXPECT_EQ(common_drift(drifts({0.0, 5e-5, 1e-4, 1e-4})), 0.0) << "quartz clocks";
}

TEST(CommonDrift, OfTheClocksIsThatOfMachineTime) {
  const ClockCorrection reference{.offset = 0.0, .drift = 0.0, .middle = 10.0},
      other{.offset = 0.3, .drift = -2e-3, .middle = 10.0};
  const ClockCorrection odd = without_drift(reference, -2e-3, 50.0), common = without_drift(other, -2e-3, 50.0);
  EXPECT_NEAR(common.drift, 0.0, 1e-15);
  EXPECT_NEAR(odd.drift, 1.0 / (1.0 - 2e-3) - 1.0, 1e-15);
  for (const double t : {0.0, 50.0, 100.0}) {
    const auto slow = [](double machine) { return 50.0 + (machine - 50.0) / (1.0 - 2e-3); };
    EXPECT_NEAR(t + odd.shift_at(t), slow(t), 1e-12);
    EXPECT_NEAR(t + common.shift_at(t), slow(t + other.shift_at(t)), 1e-12);
  }
  EXPECT_NEAR(without_drift(reference, -2e-3, 50.0).shift_at(50.0), 0.0, 1e-12);
}

TEST(SensorClocks, AreUnobservableForASensorThatNeverMoves) {
  InsRecording recording = two_clocks(0.0, 0.0, 60.0);
  for (auto& axis : recording.sensors[1].angular_velocity.axis) std::fill(axis.begin(), axis.end(), 0.001f);
  EXPECT_FALSE(estimate_sensor_clocks(recording)[1].known);
}

TEST(SensorClocks, HandleARecordingThatIsTooShort) {
  EXPECT_EQ(estimate_sensor_clocks(two_clocks(0.0, 0.0, 1.0)).size(), 2u);
}

}  // namespace
}  // namespace kinfer
