// SPDX-License-Identifier: Apache-2.0
#include "kinfer/inertial/sensor_clocks.hpp"

#include <gtest/gtest.h>

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
