// SPDX-License-Identifier: Apache-2.0
#include "kinfer/inertial/clock_offset.hpp"

#include <gtest/gtest.h>

#include "support/carried_sensor.hpp"

namespace kinfer {
namespace {

using testing::carried;
using testing::CarriedSensor;

InsRecording two_loggers(double shift, double other_rate) {
  const SensorModel grade = *sensor_grade("industrial");
  CarriedSensor a = carried({.seconds = 60.0, .grade = &grade, .has_magnetometer = false});
  CarriedSensor b = carried({.seconds = 60.0,
                             .sampling_rate = other_rate,
                             .mounting = Quat(from_rpy({1, 2, 3})),
                             .grade = &grade,
                             .has_magnetometer = false,
                             .seed = 5});
  for (double& t : b.time) t += shift;
  InsRecording recording;
  recording.loggers = {{"a", a.time}, {"b", b.time}};
  recording.sensors = {a.sensor, b.sensor};
  recording.sensors[1].logger = 1;
  return recording;
}

TEST(ClockOffset, IsFoundForAnyStartAndRateOfTheClocks) {
  for (const double shift : {0.0, 0.0137, -7.25, 1000.003})
    for (const double sampling_rate : {200.0, 125.0}) {
      const ClockOffset found = estimate_clock_offset(two_loggers(shift, sampling_rate), 0, 1);
      EXPECT_NEAR(found.seconds, -shift, 0.004) << shift << " s at " << sampling_rate << " Hz";
      EXPECT_GT(found.correlation, 0.95);
    }
}

TEST(ClockOffset, IsUnobservableFromStationarySensors) {
  InsRecording recording = two_loggers(1.0, 200.0);
  for (InsSensor& s : recording.sensors)
    for (auto& axis : s.angular_velocity.axis) std::fill(axis.begin(), axis.end(), 0.001f);
  EXPECT_EQ(estimate_clock_offset(recording, 0, 1).correlation, 0.0);
}

}  // namespace
}  // namespace kinfer
